// Counts of what a save wrote.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace prismesh::mesh::deck {

struct SaveReport {
  std::size_t nodes_written = 0;  ///< moved ones
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t shells_changed = 0;  ///< with other nodes than before
  std::size_t shells_added = 0;
  std::size_t shells_removed = 0;
  std::size_t set_cards_changed = 0;  ///< sets, segments and other cards that name added or removed ones
  std::size_t lines_changed = 0;      ///< lines that were added, removed or changed
  std::vector<std::filesystem::path> files_written;
  std::vector<std::string> notes;  ///< fields that couldn't hold the full precision, ...
};

}  // namespace prismesh::mesh::deck
