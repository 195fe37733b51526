// Collects warnings about a deck: each kind, or each thing by name, once, with its first places and a count of the others.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

class Warnings {
 public:
  /// Keeps the message of the first of a kind, the lines of the next two, and the count of all.
  void note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count = 1);
  /// For what a user must know by name, such as each missing file: counts only equal messages about the same file together. After 100 of
  /// a kind the others are counted in one entry.
  void note_each(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message);
  /// The warnings as Deck::warnings has them. Line numbers are counted here, in one pass over each file.
  std::vector<Warning> finish(std::span<const SourceFile> files) const;

 private:
  struct WarningEntry {
    std::string kind;
    std::uint32_t file;
    std::size_t offset;
    std::string message;
    std::size_t count;
    std::vector<std::pair<std::uint32_t, std::size_t>> others{};  ///< file and offset of the next
    bool each = false;                                            ///< from note_each
  };
  std::vector<WarningEntry> entries_;
};

}  // namespace prismesh::mesh::deck
