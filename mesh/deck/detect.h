// Recognises the format of a file from its first part, or what else it looks like.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

struct Detected {
  std::optional<Format> format;
  std::string looks_like;  ///< where it is no deck: "an empty file", "a ZIP archive", ...
};

Detected detect_format(std::string_view text);

}  // namespace prismesh::mesh::deck
