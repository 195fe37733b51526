// Counts the shells of each part that warn and fail, from a snapshot's arrays.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kiosk/render/model_source.h"
#include "kiosk/tools/parts/part_tree.h"

namespace prismesh::kiosk::tools::parts {

/// Keeps the counts of each chunk, so that a newer generation costs its changed chunks only.
class PartErrors {
 public:
  /// By PartIndex. Shells whose part isn't among the source's are left out.
  std::vector<Errors> count(const render::ModelSource& source);

 private:
  struct Chunk {
    std::uint64_t parts_version = 0, quality_version = 0;
    bool known = false;
    std::vector<std::pair<std::uint32_t, Errors>> errors;  ///< by part; a part may be there more than once
  };
  std::uint64_t document_ = 0;
  std::vector<Chunk> chunks_;
};

}  // namespace prismesh::kiosk::tools::parts
