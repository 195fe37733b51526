#include "mesh/document/cluster_signs.h"

#include <algorithm>
#include <limits>

#include "mesh/document/clusters.h"

namespace prismesh::mesh::document {

const ChunkedArray<ClusterSign>& ClusterSigns::of(const std::shared_ptr<const Generation>& opened, const Generation& now) {
  if (opened_ == opened && clusters_ == now.clusters) return signs_;
  opened_ = opened;
  clusters_ = now.clusters;
  const std::vector<std::uint8_t> worse = made_worse(*opened, now);
  if (signs_.size() != worse.size()) signs_ = ChunkedArray<ClusterSign>::filled(worse.size());
  for (std::size_t i = 0; i < worse.size(); ++i) {
    const quality::TriangleCluster& cluster = (*clusters_)[i];
    const auto triangles = std::min<std::size_t>(cluster.triangles, std::numeric_limits<std::uint16_t>::max());
    const ClusterSign sign{cluster.shell, static_cast<std::uint16_t>(triangles), cluster.corner, worse[i]};
    if (!(signs_[i] == sign)) signs_.set(i, sign);
  }
  return signs_;
}

}  // namespace prismesh::mesh::document
