// The clusters of triangles of a snapshot, as views show them.
#pragma once

#include <cstdint>
#include <memory>

#include "ipc/snapshot_info.h"
#include "mesh/document/generation.h"

namespace prismesh::ipc {

/// Keeps its result from one generation to the next, so that clusters that don't change stay the same chunks.
class ClusterSigns {
 public:
  /// The clusters of `now`, and which of them edits made worse since `opened`.
  const mesh::ChunkedArray<SnapshotCluster>& of(const std::shared_ptr<const mesh::document::Generation>& opened,
                                                const mesh::document::Generation& now);

 private:
  std::shared_ptr<const mesh::document::Generation> opened_;
  std::shared_ptr<const mesh::quality::TriangleClusters> clusters_;  ///< that signs_ is made of
  mesh::ChunkedArray<SnapshotCluster> signs_;
};

}  // namespace prismesh::ipc
