// A model that is shown, as mesh/ takes it: a copy of its shells, brought up to date chunk by chunk.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kiosk/render/model_source.h"
#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

/// Needs no graphics. A copy, as another process may change the memory that a source is made of while it is read.
class ModelCopy {
 public:
  /// Takes over the chunks whose versions differ. Throws std::bad_alloc.
  void update(const ModelSource& source);
  void clear() { *this = ModelCopy(); }

  /// Positions, corners and parts of shells; no ids, no adjacency, no other elements. A shell with a node out of range is a removed one.
  const mesh::Model& model() const { return model_; }
  /// By PartIndex, 1 = hidden.
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }

 private:
  mesh::Model model_;
  std::vector<std::uint8_t> hidden_;
  std::uint64_t document_ = 0;
  std::array<std::vector<std::uint64_t>, 3> versions_;  ///< of the chunks of positions, corners, parts
};

}  // namespace prismesh::kiosk::render
