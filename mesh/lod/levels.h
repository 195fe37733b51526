// Levels of detail of a model's shells: a hierarchy of clusters from which a view chooses, without cracks, by the error in pixels that it
// allows. Method: groups of neighbouring clusters are simplified together while the nodes that they share with other groups stay, and are
// cut into new clusters of half as many triangles [Karis 2021], with collapses of edges [Garland 1997]. Coarse triangles have nodes of the
// model, so they move with them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::lod {

/// Stands for shells of one part.
struct CoarseTriangle {
  std::array<NodeIndex, 3> node;
  ShellIndex shell;  ///< one of these shells: gives the look
};

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = -1;  ///< below 0: empty
};

/// Clusters that are shown or replaced together.
struct Group {
  Sphere sphere;     ///< around all that its clusters stand for; inside that of the group that replaces them
  double error = 0;  ///< how far its triangles may be from the shells that they stand for; no smaller than that of the groups inside it
  double side = 0;   ///< the longest mean side of a cluster of shells that it stands for
  std::uint32_t first_cluster = 0;  ///< the clusters that it made: Levels::clusters [first_cluster, first_cluster + clusters)
  std::uint32_t clusters = 0;
};

inline constexpr std::uint32_t kNoGroup = std::numeric_limits<std::uint32_t>::max();

struct Cluster {
  Sphere bounds;            ///< of its own shells or triangles
  std::uint32_t first = 0;  ///< in Levels::shells, of those below Levels::shell_clusters; else in Levels::triangles
  std::uint32_t count = 0;
  std::uint32_t made_by = kNoGroup;  ///< of shells: none
  std::uint32_t replaced_by = kNoGroup;
};

struct Levels {
  std::vector<ShellIndex> shells;         ///< those that can be drawn, cluster by cluster
  std::vector<CoarseTriangle> triangles;  ///< cluster by cluster
  std::vector<Cluster> clusters;          ///< those of shells first; a group's before those that replace them
  std::size_t shell_clusters = 0;
  std::vector<Group> groups;  ///< those inside others first
};

/// Leaves out removed shells and shells with a coordinate that isn't finite. The result depends on the model only. Uses all cores. Errors:
/// cancelled.
Result<Levels> build_levels(const Model& model, const Progress& progress = {});

/// By group: by how much nodes of the shells that it stands for have moved at most since the levels were made. `by_cluster`: the same for
/// each of the clusters of shells; infinite: its shells must be seen as they are. Costs a look at each cluster.
std::vector<float> added_errors(const Levels& levels, std::span<const float> by_cluster);

}  // namespace prismesh::mesh::lod
