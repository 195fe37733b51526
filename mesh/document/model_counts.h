// How large a model is, and how good, in a line of a list.
#pragma once

#include <cstdint>

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

struct ModelCounts {
  std::uint64_t nodes = 0;
  std::uint64_t elements = 0;  ///< of all classes
  std::uint64_t parts = 0;
  std::uint64_t warn = 0;  ///< shells whose worst grade is warn
  std::uint64_t fail = 0;
  bool operator==(const ModelCounts&) const = default;
};

/// Of the current generation. Elements that aren't shells are counted as the deck has them: edits leave them alone or add few.
ModelCounts count_model(const Document& document);

}  // namespace prismesh::mesh::document
