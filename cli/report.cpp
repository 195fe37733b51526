// Writes what changed between two decks as one page of HTML: computed by mesh/report, with pictures by the headless kiosk.
#include "mesh/report/change_report.h"

#include <filesystem>
#include <ostream>

#include "base/file.h"
#include "cli/commands.h"
#include "cli/draw_picture.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "cli/temporary_folder.h"
#include "mesh/deck/open.h"
#include "mesh/document/open.h"
#include "mesh/report/change_page.h"

namespace prismesh::cli {

namespace {

using mesh::document::Document;
using mesh::report::ChangePictures;
using mesh::report::ChangeReport;
using mesh::report::PagePicture;

constexpr const char* kSmall = "960x600";
constexpr const char* kLarge = "1360x850";

/// Opens the second deck, judged as the first where that is possible.
Result<Document> open_after(const std::filesystem::path& path, const Document& before, const Common& common, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + path.filename().string(), clock);
  const auto named = [&](Error error) {
    if (error.file.empty()) error.file = path.string();
    return fail(std::move(error));
  };
  Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(path, bar.progress());
  if (!opened) return named(std::move(opened.error()));
  mesh::document::OpenOptions options = open_options(common);
  if (mesh::report::can_be_judged_alike({before.deck, before.current().model}, *opened)) {
    options.judged_by = before.current().judging;
    options.settings = before.settings;
  }
  Result<Document> document = mesh::document::open(path, std::move(*opened), options);
  if (!document) return named(std::move(document.error()));
  return document;
}

/// Draws pictures into a folder that goes when they are read.
class Artist {
 public:
  Artist(std::filesystem::path folder, std::string view, const Context& context)
      : folder_(std::move(folder)), view_(std::move(view)), context_(context) {}

  PagePicture draw(const Document& document, std::string caption, std::vector<std::string> more, int field = -1) {
    more.insert(more.end(), {"--profile", "mono", "--view", view_});
    const std::filesystem::path file = folder_ / "picture.png";
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    const Result<int> status = draw_picture(document, file, more, field, context_);
    if (!status) return without(status.error().text());
    const Result<FileBytes> bytes = read_file(file);
    if (*status != kDone || !bytes) return without("the kiosk couldn't draw it");
    return {std::string(bytes->text()), std::move(caption)};
  }
  /// The first reason why there is a picture missing; empty: there is none.
  const std::string& missing() const { return missing_; }

 private:
  PagePicture without(const std::string& why) {
    if (missing_.empty()) missing_ = why;
    return {"", "No picture: " + why};
  }

  std::filesystem::path folder_;
  std::string view_;
  const Context& context_;
  std::string missing_;
};

/// Displacement in colours, of the whole model and of what changed; what changed without colours where no node has moved.
void draw_differences(const Document& before, const Document& after, const ChangeReport& report, Artist& artist, ChangePictures& pictures) {
  if (!report.changed) return;
  const std::vector<std::string> near{"--size", kLarge, "--box", box_argument(*report.changed)};
  if (report.difference.max_displacement > 0) {
    const double most = report.difference.max_displacement;
    const Result<SealedField> field =
        seal_field(after, {}, &before.current().model, "against " + report.before.name, displacement_limits(most));
    if (!field) {
      pictures.differences.push_back({"", "No picture of the displacement: " + field.error().text()});
    } else {
      const auto draw = [&](std::vector<std::string> more, const char* caption) {
        more.insert(more.end(), field->arguments.begin(), field->arguments.end());
        more.insert(more.end(), {"--legend", "below"});
        pictures.differences.push_back(artist.draw(after, caption, std::move(more), field->values.get()));
      };
      draw({"--size", kLarge}, "The difference: how far nodes moved. What didn't move has the colour of its part.");
      draw(near, "The same, close to what changed.");
      return;
    }
  }
  std::vector<std::string> closer = near;
  pictures.differences.push_back(artist.draw(after, "Close to what changed, after.", std::move(closer)));
}

ChangePictures draw_pictures(const Document& before, const Document& after, const ChangeReport& report, Artist& artist) {
  ChangePictures pictures;
  pictures.before = artist.draw(before, "Before: " + report.before.name, {"--size", kSmall});
  pictures.after = artist.draw(after, "After: " + report.after.name, {"--size", kSmall});
  draw_differences(before, after, report, artist, pictures);
  return pictures;
}

}  // namespace

int report(const ReportOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<Document> before = open_deck(options.a, common, context);
  if (!before) return refuse(before.error());
  const Result<Document> after = open_after(options.b, *before, common, context);
  if (!after) return refuse(after.error());
  for (const Document* document : {&*before, &*after})
    if (const Result<void> other = check_replaces_no_deck(options.output, *document); !other) return refuse(other.error());
  std::error_code unlike;
  if (options.journal && std::filesystem::equivalent(options.output, *options.journal, unlike) && !unlike)
    return refuse({options.output.string(), 0, "is the journal, and would be replaced: name another file with -o"});
  Result<std::optional<mesh::report::KnownEdits>> edits = std::optional<mesh::report::KnownEdits>();
  if (options.journal) {
    Result<mesh::report::KnownEdits> known = mesh::report::known_edits(*options.journal, *before);
    if (!known) return refuse(known.error());
    edits = std::move(*known);
  }
  if (!options.done.empty()) edits = mesh::report::KnownEdits{"the open document", options.done, false, {}};
  say_warnings(context, *before);
  say_warnings(context, *after);
  say_guesses(context, *before);
  ChangeReport report = mesh::report::change_report(*before, *after);
  report.edits = std::move(*edits);
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return refuse(folder.error());
  Artist artist(folder->path(), options.view, context);
  const ChangePictures pictures = draw_pictures(*before, *after, report, artist);
  if (context.stop()) return refuse({options.output.string(), 0, "stopped; nothing is written"});
  if (!artist.missing().empty()) say(context, Error{options.output.string(), 0, "warning: a picture is missing: " + artist.missing()});
  const std::string page = mesh::report::change_page(report, pictures);
  const PendingFile file{options.output, {page}};
  if (const Result<void> written = replace_files({&file, 1}); !written) return refuse(written.error());
  if (common.json) context.out << report_json(options.output.string(), page.size(), artist.missing()) << '\n';
  return kDone;
}

}  // namespace prismesh::cli
