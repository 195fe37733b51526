// Moves the nodes of a spring net over the surface until the spring forces balance, as far as element quality allows. Method:
// docs/relaxing.md. Private to mesh/relax.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/relax/options.h"
#include "mesh/relax/quality_guard.h"
#include "mesh/relax/spring_net.h"

namespace prismesh::mesh::relax {

struct SolverResult {
  int rounds = 0;
  bool converged = false;
  bool was_stopped = false;  ///< by the callbacks
};

/// Functions that report progress and can stop the solver: each returns false to stop it.
struct SolverCallbacks {
  std::function<bool(double at_rest)> round_done;  ///< called after each round with the share of nodes at rest
  std::function<bool()> goes_on;                   ///< called several times in a round
};

/// Limits which nodes may move: a node that is displaced by more than the threshold allows its neighbours to move as well.
struct Spreading {
  double threshold = 0;               ///< deck's length unit
  std::vector<std::uint8_t> allowed;  ///< by movable node; 1: it may move
};

class SpringSolver {
 public:
  SpringSolver(const SpringNet& net, const ReferenceSurface& surface, const QualityGuard& guard, const Options& options);

  /// Runs rounds until every node is at rest and the guard finds no bad shell, or Options::max_rounds. `spreading`: which nodes may move;
  /// null: all.
  SolverResult run(Spreading* spreading, const SolverCallbacks& callbacks);

  std::vector<Vec3> at;               ///< positions of all nodes of the net; on the surface after run()
  std::vector<SurfaceAnchor> anchor;  ///< of the movable ones
  std::vector<std::uint8_t> limited;  ///< by movable node; 1: it stopped at its max move
  std::vector<std::uint8_t> held;     ///< by movable node; 1: it stopped because a shell would get too bad

 private:
  enum class CheckResult { ok, bad_shells, stopped };
  std::optional<std::size_t> round(Spreading* spreading, const SolverCallbacks& callbacks);
  bool visit(std::uint32_t node, Spreading* spreading);
  bool step(std::size_t node);
  Vec3 balancing_step(std::size_t node) const;
  void step_freely(std::size_t node, const Vec3& move);
  void step_checked(std::size_t node, const Vec3& move);
  void return_to_surface(std::size_t node);
  bool return_all(const SolverCallbacks& callbacks);
  CheckResult check(bool at_rest, const SolverCallbacks& callbacks);
  std::optional<double> limit_of(std::size_t node) const;
  const Vec3& limit_origin(std::size_t node) const;

  const SpringNet& net_;
  const ReferenceSurface& surface_;
  const QualityGuard& guard_;
  const Options& options_;
  std::vector<Vec3> last_accepted_;    ///< positions that the guard's last check left
  std::vector<Vec3> last_step_;        ///< each node's last step
  float gain_recovery_ = 1.05F;        ///< factor on the gain with each step that doesn't turn back
  std::vector<float> gain_;            ///< factor on each node's step to its balance
  std::vector<float> drift_;           ///< length that each node has moved since it was last put back on the surface
  std::vector<std::uint8_t> active_;   ///< 1: the node or a neighbour has moved since the node's last step
  std::vector<std::uint8_t> checked_;  ///< 1: each step of the node ends on the surface and is checked by the guard
};

}  // namespace prismesh::mesh::relax
