// Springs settling: node after node goes where its springs balance, over the surface, as far as its shells allow. Private to mesh/relax.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/relax/guard.h"
#include "mesh/relax/net.h"
#include "mesh/relax/options.h"

namespace prismesh::mesh::relax {

struct Settled {
  int rounds = 0;
  bool converged = false;
  bool was_stopped = false;  ///< by the watcher
};

/// Who waits for the springs to settle; false stops them.
struct Watcher {
  std::function<bool(double at_rest)> round_done;  ///< hears the share of nodes at rest after each round
  std::function<bool()> goes_on;                   ///< asked now and then in between
};

/// A node may move once it is allowed to; one that is displaced by more than the threshold allows its neighbours.
struct Spreading {
  double threshold = 0;
  std::vector<std::uint8_t> allowed;  ///< of the movable nodes
};

class Settling {
 public:
  Settling(const Net& net, const ReferenceSurface& surface, const Guard& guard, const Options& options);

  /// Rounds until nothing moves any more and the guard has nothing to hold back. `spreading`: null to let all move at once.
  Settled run(Spreading* spreading, const Watcher& watcher);

  std::vector<Vec3> at;               ///< of all nodes of the net; on the surface after run()
  std::vector<SurfaceAnchor> anchor;  ///< of the movable ones
  std::vector<std::uint8_t> limited;  ///< those that stopped at their limit
  std::vector<std::uint8_t> held;     ///< those that would go on, if their shells allowed it

 private:
  enum class Found { nothing, bad_shells, told_to_stop };
  std::optional<std::size_t> round(Spreading* spreading, const Watcher& watcher);
  bool visit(std::uint32_t node, Spreading* spreading);
  bool step(std::size_t node);
  Vec3 balancing_step(std::size_t node) const;
  void go(std::size_t node, const Vec3& move);
  void go_carefully(std::size_t node, const Vec3& move);
  void land(std::size_t node);
  bool land_all(const Watcher& watcher);
  Found check(bool at_rest, const Watcher& watcher);
  std::optional<double> limit_of(std::size_t node) const;
  const Vec3& home_of(std::size_t node) const;

  const Net& net_;
  const ReferenceSurface& surface_;
  const Guard& guard_;
  const Options& options_;
  std::vector<Vec3> good_;             ///< where the nodes were when the guard last looked, and found nothing or took back what it found
  std::vector<Vec3> last_;             ///< each node's last step
  float recovery_ = 1.05F;             ///< of the gain with each step that doesn't turn back
  std::vector<float> gain_;            ///< how far beyond its balance, or short of it, each node goes
  std::vector<float> drift_;           ///< since each was last put back on the surface
  std::vector<std::uint8_t> awake_;    ///< it or a neighbour has moved
  std::vector<std::uint8_t> careful_;  ///< each step ends on the surface, and where the node's shells allow it
};

}  // namespace prismesh::mesh::relax
