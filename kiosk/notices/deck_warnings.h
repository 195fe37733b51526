// Words a deck's warnings for the user; those that leave something out of the model come first.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::kiosk::notices {

struct ToldWarning {
  bool is_error = false;  ///< something of the deck, or of its edits, isn't in the model
  std::string place;      ///< "FILE:LINE"
  std::string text;       ///< with the number of times
};

/// Errors first, otherwise in the deck's order.
std::vector<ToldWarning> told_warnings(std::span<const mesh::deck::Warning> warnings);

std::size_t error_count(std::span<const ToldWarning> warnings);

/// "1 error and 12 warnings".
std::string counts_of(std::span<const ToldWarning> warnings);

}  // namespace prismesh::kiosk::notices
