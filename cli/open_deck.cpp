#include "cli/open_deck.h"

#include "base/child_process.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "ipc/import/client.h"
#include "mesh/deck/save.h"
#include "mesh/document/deck_settings.h"
#include "mesh/document/save.h"

namespace prismesh::cli {

mesh::document::OpenOptions open_options(const Common& common) {
  mesh::document::OpenOptions options;
  options.length_unit = common.length_unit;
  options.rules = common.rules;
  return options;
}

Result<mesh::document::Document> open_deck(const std::filesystem::path& deck, const Common& common, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + deck.filename().string(), clock);
  mesh::document::OpenOptions options = open_options(common);
  options.progress = bar.progress();
  Result<mesh::document::Document> document = mesh::document::open(deck, options);
  if (!document && document.error().file.empty()) document.error().file = deck.string();
  return document;
}

Result<mesh::document::Document> open_sandboxed(const std::filesystem::path& deck, const Common& common, const Context& context) {
  const Result<std::filesystem::path> program = program_beside("prismesh-import", "which reads decks in a sandbox", "prismesh");
  if (!program) return fail(program.error());
  ipc::ImportOptions how;
  how.program = *program;
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + deck.filename().string(), clock);
  how.progress = bar.progress();
  Result<ipc::ImportedDeck> imported = ipc::import_deck(deck, how);
  if (imported) {
    for (const std::string& sentence : imported->unguarded) say(context, Error{deck.string(), 0, "note: " + sentence});
    mesh::document::OpenOptions options = open_options(common);
    options.read_settings_file = false;
    Result<mesh::document::Document> document = mesh::document::open(deck, std::move(imported->opened), options);
    if (document) return document;
    imported = fail(std::move(document.error()));
  }
  if (imported.error().file.empty()) imported.error().file = deck.string();
  return fail(std::move(imported.error()));
}

Result<void> check_replaces_no_deck(const std::filesystem::path& output, const mesh::document::Document& document) {
  for (const mesh::deck::SourceFile& file : document.deck->files) {
    std::error_code other;
    if (std::filesystem::equivalent(output, file.path, other) && !other)
      return fail(output.string(), "is a file of the deck, and would be replaced: name another file with -o");
  }
  return {};
}

Result<mesh::deck::SaveReport> save_deck(const mesh::document::Document& document, const std::filesystem::path& target,
                                         const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "saving " + target.filename().string(), clock);
  Result<mesh::deck::SaveReport> saved = mesh::document::save(document, target, bar.progress());
  if (!saved && saved.error().file.empty()) saved.error().file = target.string();
  return saved;
}

bool save_settings(const mesh::document::Document& document, const Context& context) {
  const std::filesystem::path file = mesh::document::deck_settings_path(document.path);
  const Result<void> written = mesh::document::write_deck_settings(document.current(), document.path);
  if (!written)
    say(context, written.error());
  else
    say(context, Error{file.string(), 0, "note: keeps the target sizes and criteria of this deck"});
  return written.has_value();
}

}  // namespace prismesh::cli
