// Springs settling: node after node goes where its springs balance, over the surface. Private to mesh/relax.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/relax/net.h"

namespace prismesh::mesh::relax {

struct Settled {
  int rounds = 0;
  bool converged = false;
  bool was_stopped = false;  ///< by the watcher
};

/// A node may move once it is allowed to; one that is displaced by more than the threshold allows its neighbours.
struct Spreading {
  double threshold = 0;
  std::vector<std::uint8_t> allowed;  ///< of the movable nodes
};

class Settling {
 public:
  Settling(const Net& net, const ReferenceSurface& surface, const Options& options);

  /// Rounds until nothing moves any more. `watch` hears the share of nodes at rest after each round; false stops. `spreading`: null to let
  /// all move at once.
  Settled run(Spreading* spreading, const std::function<bool(double at_rest)>& watch);

  std::vector<Vec3> at;               ///< of all nodes of the net; on the surface after run()
  std::vector<Footing> footing;       ///< of the movable ones
  std::vector<std::uint8_t> limited;  ///< those that stopped at their limit

 private:
  bool step(std::size_t node);
  void land(std::size_t node);
  std::optional<double> limit_of(std::size_t node) const;

  const Net& net_;
  const ReferenceSurface& surface_;
  const Options& options_;
  std::vector<Vec3> last_;  ///< each node's last step
  float recovery_ = 1.05F;
  std::vector<float> gain_;          ///< how far beyond its balance, or short of it, each node goes
  std::vector<float> drift_;         ///< since each was last put back on the surface
  std::vector<std::uint8_t> awake_;  ///< it or a neighbour has moved
};

}  // namespace prismesh::mesh::relax
