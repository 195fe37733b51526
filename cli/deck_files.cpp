#include "cli/deck_files.h"

#include <algorithm>
#include <map>
#include <system_error>

#include "cli/open_deck.h"
#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

namespace fs = std::filesystem;

/// Whether a file lies beneath a folder without its links. What can't be asked for counts as outside.
bool lies_beneath(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  if (error) return false;
  return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end();
}

std::ptrdiff_t folders_up(const fs::path& relative) { return std::count(relative.begin(), relative.end(), fs::path("..")); }

}  // namespace

Result<DeckFiles> files_of(const mesh::deck::Deck& deck) {
  std::map<fs::path, fs::path> on_disk;  // by the path relative to the main file's folder
  std::map<fs::path, FileIdentity> read;
  for (const mesh::deck::SourceFile& file : deck.files) {
    on_disk.emplace(file.relative.lexically_normal(), file.path);
    read.emplace(file.path, file.bytes.identity());
  }
  for (const mesh::deck::CompanionFile& file : deck.companions) on_disk.emplace(file.relative.lexically_normal(), file.path);
  std::ptrdiff_t up = 0;
  for (const auto& [relative, path] : on_disk) {
    if (relative.is_absolute())
      return fail(path.string(), "has an absolute name in the deck; a stored model has its files beneath one folder");
    up = std::max(up, folders_up(relative));
  }
  std::error_code error;
  fs::path outer = fs::absolute(deck.files.front().path, error).lexically_normal().parent_path(), prefix;
  for (std::ptrdiff_t i = 0; i < up; ++i) {
    if (error || !outer.has_relative_path()) return fail(deck.files.front().path.string(), "has includes that lie above all folders");
    prefix = outer.filename() / prefix;
    outer = outer.parent_path();
  }
  DeckFiles found;
  found.leaves_folder = up > 0;
  const fs::path main = deck.files.front().path, folder = fs::canonical(fs::absolute(main).parent_path(), error);
  for (const auto& [relative, path] : on_disk)
    if (path != main && (folders_up(relative) > 0 || !lies_beneath(path, folder))) found.outside.push_back(path);
  for (const auto& [relative, path] : on_disk) {
    ipc::store::LocalFile file{path, (prefix / relative).lexically_normal().generic_string()};
    if (const auto as_read = read.find(path); as_read != read.end()) file.as_read = as_read->second;
    found.files.push_back(std::move(file));
  }
  found.main = (prefix / deck.files.front().relative).lexically_normal().generic_string();
  return found;
}

Result<DeckFiles> files_of_deck(const fs::path& path, const Common& common, const Context& context) {
  const Result<mesh::document::Document> document = open_deck(path, common, context);
  if (!document) return fail(document.error());
  for (const mesh::deck::Warning& warning : document->deck->warnings)
    if (warning.kind == "missing-include") say(context, Error{warning.file, warning.line, warning.message});
  return files_of(*document->deck);
}

}  // namespace prismesh::cli
