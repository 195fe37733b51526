#include "cli/deck_files.h"

#include <algorithm>
#include <map>
#include <system_error>

namespace prismesh::cli {

namespace {

namespace fs = std::filesystem;

std::ptrdiff_t folders_up(const fs::path& relative) { return std::count(relative.begin(), relative.end(), fs::path("..")); }

}  // namespace

Result<DeckFiles> files_of(const mesh::deck::Deck& deck) {
  std::map<fs::path, fs::path> on_disk;  // by the path relative to the main file's folder
  for (const mesh::deck::SourceFile& file : deck.files) on_disk.emplace(file.relative.lexically_normal(), file.path);
  for (const mesh::deck::CompanionFile& file : deck.companions) on_disk.emplace(file.relative.lexically_normal(), file.path);
  std::ptrdiff_t up = 0;
  for (const auto& [relative, path] : on_disk) {
    if (relative.is_absolute())
      return fail(path.string(), "has an absolute name in the deck; a model at a station has its files beneath one folder");
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
  for (const auto& [relative, path] : on_disk) found.files.push_back({path, (prefix / relative).lexically_normal().generic_string()});
  found.main = (prefix / deck.files.front().relative).lexically_normal().generic_string();
  return found;
}

}  // namespace prismesh::cli
