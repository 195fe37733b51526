// Collects what is odd about a deck: each kind once, with its first place and how often.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/deck.h"

namespace prismesh::mesh::deck::lsdyna {

class Warnings {
 public:
  /// `message` is kept of the first of its kind only.
  void note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count = 1);
  /// As the deck tells them; line numbers are counted only here, once a kind.
  std::vector<Warning> finish(std::span<const SourceFile> files) const;

 private:
  struct Entry {
    std::string kind;
    std::uint32_t file;
    std::size_t offset;
    std::string message;
    std::size_t count;
  };
  std::vector<Entry> entries_;
};

}  // namespace prismesh::mesh::deck::lsdyna
