#include "mesh/document/edit.h"

#include <filesystem>
#include <optional>
#include <ostream>
#include <system_error>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/edit_list.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/deck/save.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/journal.h"
#include "mesh/document/prepare.h"

namespace prismesh::cli {

namespace {

namespace document = mesh::document;

/// A journal that is removed when the command fails.
class JournalGuard {
 public:
  Result<void> create(const std::filesystem::path& path, const document::Document& document) {
    Result<document::Journal> created = document::Journal::create(path, document);
    if (!created) return fail(created.error());
    journal_.emplace(std::move(*created));
    path_ = path;
    return {};
  }
  ~JournalGuard() {
    if (!journal_ || kept_) return;
    journal_.reset();
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Result<void> append(const document::Document& document, const document::Edit& edit, const document::Prepared& prepared) {
    return journal_ ? journal_->append(document, edit, prepared) : Result<void>();
  }
  void keep() { kept_ = true; }

 private:
  std::optional<document::Journal> journal_;
  std::filesystem::path path_;
  bool kept_ = false;
};

bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored);
}

/// Prints why an edit wasn't applied: the reason, and the edit's place if the reason has another one.
void refuse_edit(const Context& context, const Common& common, const WantedEdit& wanted, Error reason) {
  const std::string edit(name(wanted.edit));
  if (common.json) context.out << failed_edit_json(edit, reason.text()) << '\n';
  if (reason.file.empty()) {
    say(context, Error{wanted.file, wanted.line, std::move(reason.message)});
    return;
  }
  say(context, reason);
  say(context, Error{wanted.file, wanted.line, "this " + edit + " was not done, and nothing is written"});
}

/// Prepares an edit with a progress bar; the user can cancel it.
Result<document::Prepared> prepare_shown(const document::Document& document, const document::Edit& edit, const Context& context) {
  MonotonicClock of_machine;
  Clock& clock = context.clock != nullptr ? *context.clock : of_machine;
  ProgressBar bar(context, std::string(name(edit)), clock);
  return document::prepare(document, edit, bar.progress(), &clock);
}

struct Applied {
  bool is_refused = false;
  std::optional<Error> stop;  ///< the user stopped the command at an edit that is kept; to be said once that is written
};

/// What to say where the user stopped the command at an edit that is kept, with `left` edits after it.
Error stop_of(const WantedEdit& at, const document::EditReport& report, std::size_t left) {
  std::string said = report.stopped ? "stopped in the middle of this edit" : "stopped after this edit";
  said += "; what was reached is written";
  if (left > 0) said += ", without the " + (left == 1 ? std::string("edit") : counted(left, "edit")) + " after it";
  return {at.file, at.line, std::move(said)};
}

/// Applies the edits in order, until one is refused or the user stops; the reason is printed.
Applied apply_all(const std::vector<WantedEdit>& wanted, document::Document& document, JournalGuard& journal, const Common& common,
                  const Context& context) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const WantedEdit& one = wanted[i];
    Result<document::Prepared> prepared = prepare_shown(document, one.edit, context);
    if (!prepared) {
      refuse_edit(context, common, one, prepared.error());
      return {true, std::nullopt};
    }
    if (const Result<void> kept = journal.append(document, one.edit, *prepared); !kept) {
      refuse_edit(context, common, one, kept.error());
      return {true, std::nullopt};
    }
    const document::EditReport report = prepared->report;
    document::commit(document, std::move(*prepared));
    if (common.json)
      context.out << edit_json(report) << '\n';
    else
      print_edit(context.out, report);
    if (context.stop() && is_kept_on_cancel(one.edit)) return {false, stop_of(one, report, wanted.size() - i - 1)};
    if (context.stop()) {
      say(context, Error{one.file, one.line, "cancelled after this edit; nothing is written"});
      return {true, std::nullopt};
    }
  }
  return {};
}

/// Saves even after the user has stopped the command at an edit that is kept.
Result<mesh::deck::SaveReport> save_applied(const document::Document& document, const std::filesystem::path& output, const Applied& applied,
                                            const Context& context) {
  Context saving = context;
  if (applied.stop) saving.interrupted = nullptr;
  return save_deck(document, output, saving);
}

}  // namespace

int edit(const EditOptions& options, const Common& common, const Context& context) {
  if (options.journal && is_one_file(*options.journal, options.output)) {
    say(context, Error{options.journal->string(), 0, "can't be both the journal and the deck that is written"});
    return kWrongUsage;
  }
  std::vector<WantedEdit> wanted;
  if (const auto refusal = read_edits(options.edits, "--edit", options.script, wanted)) {
    say(context, refusal->error);
    return refusal->status;
  }
  if (options.keep_on_cancel) keep_on_cancel(wanted);
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  Result<document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  say_warnings(context, *document);
  if (!wanted.empty()) say_guesses(context, *document);
  JournalGuard journal;
  if (options.journal)
    if (const Result<void> created = journal.create(*options.journal, *document); !created) return refuse(created.error());
  const Applied applied = apply_all(wanted, *document, journal, common, context);
  if (applied.is_refused || !output_is_good(context)) return kFailed;
  const Result<mesh::deck::SaveReport> saved = save_applied(*document, options.output, applied, context);
  if (!saved) return refuse(saved.error());
  journal.keep();
  for (const std::string& note : saved->notes) say(context, Error{options.output.string(), 0, "note: " + note});
  if (applied.stop) say(context, *applied.stop);
  return applied.stop ? kFailed : kDone;
}

}  // namespace prismesh::cli
