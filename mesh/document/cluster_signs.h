// The clusters of triangles of a generation, as views show them.
#pragma once

#include <cstdint>
#include <memory>

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// A node with too many triangles about it (mesh/quality/triangle_clusters.h).
struct ClusterSign {
  ShellIndex shell;  ///< one of them
  std::uint16_t triangles = 0;
  std::uint8_t corner = 0;  ///< of that shell, at the node
  std::uint8_t worse = 0;   ///< 1: the document's edits added triangles there
  bool operator==(const ClusterSign&) const = default;
};

/// Keeps its result from one generation to the next, so that clusters that don't change stay the same chunks.
class ClusterSigns {
 public:
  /// The clusters of `now`, and which of them edits made worse since `opened`.
  const ChunkedArray<ClusterSign>& of(const std::shared_ptr<const Generation>& opened, const Generation& now);

 private:
  std::shared_ptr<const Generation> opened_;
  std::shared_ptr<const quality::TriangleClusters> clusters_;  ///< that signs_ is made of
  ChunkedArray<ClusterSign> signs_;
};

}  // namespace prismesh::mesh::document
