// Collects what is odd about a deck: each kind, or each thing named, once, with its first places and how many more there are.
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
  /// `message` is kept of the first of its kind only; of those that follow the next two lines are told, and how many more there are.
  void note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count = 1);
  /// For what a user must hear of by name, as each file that lacks: only what says the same of the same file is put together.
  /// After 100 of a kind the others are counted in one.
  void note_each(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message);
  /// As the deck tells them; line numbers are counted only here.
  std::vector<Warning> finish(std::span<const SourceFile> files) const;

 private:
  struct WarningEntry {
    std::string kind;
    std::uint32_t file;
    std::size_t offset;
    std::string message;
    std::size_t count;
    std::vector<std::pair<std::uint32_t, std::size_t>> others{};  ///< file and offset of the next
    bool each = false;                                            ///< what is counted all says the same of the same file
  };
  std::vector<WarningEntry> entries_;
};

}  // namespace prismesh::mesh::deck
