#include "mesh/relax/spring_solver.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/relax/interruptible_loop.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kSolverGrain = 512;
constexpr double kAtRest = 2e-3;         ///< of the size: a node that moves less in a round is at rest
constexpr double kMaxStep = 0.25;        ///< of the size, in a round
constexpr double kMaxDrift = 0.2;        ///< of the size: a node that has moved farther is put back on the surface
constexpr float kMaxGain = 1.5F;         ///< factor on the step to the balance; above 1, since the neighbours follow
constexpr float kMinGain = 0.02F;        ///< the factor where steps turn back again and again
constexpr int kGainRecoveryRounds = 50;  ///< only before that the factor of a node that turned back grows again
constexpr double kTurnBack = 0.25;       ///< of the last step: a step farther back is an oscillation
constexpr double kMaxUndone = 0.5;       ///< of the drift: where putting a node back on the surface undoes more, its steps are checked
constexpr int kFirstCheck = 12;          ///< rounds until the guard's first check
constexpr int kChecksApart = 3;          ///< factor on the rounds until each next check

/// Spring force along the two directions in which a node may move, and its stiffness matrix there: 2x2, symmetric.
struct Pull {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

Pull pull_on(const Vec3& at, std::span<const Spring> springs, const std::vector<Vec3>& positions, const Vec3& u, const Vec3& v) {
  Pull pull;
  for (const Spring& spring : springs) {
    const Vec3 d = positions[spring.to] - at;
    const double length2 = d.squaredNorm();
    if (!(length2 > 0)) continue;
    const double stretch = 1 - spring.rest / std::sqrt(length2);
    const double du = d.dot(u), dv = d.dot(v);
    pull.u += spring.weight * stretch * du;
    pull.v += spring.weight * stretch * dv;
    // A compressed spring has negative lateral stiffness: left out, so that the matrix is positive and the step lowers the energy.
    const double sideways = std::max(stretch, 0.0);
    const double along = spring.weight * (1 - sideways) / length2;
    pull.uu += spring.weight * sideways + along * du * du;
    pull.uv += along * du * dv;
    pull.vv += spring.weight * sideways + along * dv * dv;
  }
  return pull;
}

}  // namespace

SpringSolver::SpringSolver(const SpringNet& net, const ReferenceSurface& surface, const QualityGuard& guard, const Options& options)
    : at(net.start),
      anchor(net.anchor),
      limited(net.movable, 0),
      held(net.movable, 0),
      net_(net),
      surface_(surface),
      guard_(guard),
      options_(options),
      last_accepted_(net.start),
      last_step_(net.movable, Vec3::Zero()),
      gain_(net.movable, kMaxGain),
      drift_(net.movable, 0),
      active_(net.movable, 1),
      checked_(net.movable, 0) {}

std::optional<double> SpringSolver::limit_of(std::size_t node) const {
  return anchor[node].freedom == Freedom::line ? options_.max_move_on_line : options_.max_move_on_surface;
}

/// The position that the node's max move counts from.
const Vec3& SpringSolver::limit_origin(std::size_t node) const {
  return options_.move_origins != nullptr ? (*options_.move_origins)[net_.nodes[node].value] : net_.start[node];
}

/// Puts a node back on the surface, within its max move.
void SpringSolver::return_to_surface(std::size_t node) {
  at[node] = move_anchor(surface_, at[node], anchor[node]);
  drift_[node] = 0;
  const std::optional<double> limit = limit_of(node);
  for (int i = 0; limit && i < 4; ++i) {
    const Vec3 move = at[node] - limit_origin(node);
    const double length = move.norm();
    if (!(length > *limit)) return;
    limited[node] = 1;
    at[node] = move_anchor(surface_, limit_origin(node) + move * (*limit / length * (1 - 1e-3 * i)), anchor[node]);
  }
  if (limit && (at[node] - limit_origin(node)).norm() > *limit) at[node] = net_.start[node];
}

/// The Newton step to where the node's springs balance.
Vec3 SpringSolver::balancing_step(std::size_t node) const {
  const SurfaceAnchor& node_anchor = anchor[node];
  if (node_anchor.freedom == Freedom::line) {
    const Pull pull = pull_on(at[node], net_.springs_of(node), at, node_anchor.direction, Vec3::Zero());
    return pull.uu > 0 ? Vec3(pull.u / pull.uu * node_anchor.direction) : Vec3::Zero();
  }
  int axis = 0;
  node_anchor.direction.cwiseAbs().minCoeff(&axis);
  const Vec3 u = node_anchor.direction.cross(Vec3::Unit(axis)).normalized();
  const Vec3 v = node_anchor.direction.cross(u);
  Pull pull = pull_on(at[node], net_.springs_of(node), at, u, v);
  const double little = 1e-3 * (pull.uu + pull.vv);
  pull.uu += little;
  pull.vv += little;
  const double determinant = pull.uu * pull.vv - pull.uv * pull.uv;
  if (!(determinant > 0)) return Vec3::Zero();
  return ((pull.vv * pull.u - pull.uv * pull.v) * u + (pull.uu * pull.v - pull.uv * pull.u) * v) / determinant;
}

/// Moves a node by the full step, or by a half or a quarter of it, or not at all: the first that the guard allows.
void SpringSolver::step_checked(std::size_t node, const Vec3& move) {
  const Vec3 was = at[node];
  const SurfaceAnchor node_anchor = anchor[node];
  held[node] = 0;
  for (const double share : {1.0, 0.5, 0.25}) {
    at[node] = was + share * move;
    return_to_surface(node);
    if (guard_.allows(static_cast<std::uint32_t>(node), at[node], at)) return;
    held[node] = 1;
    anchor[node] = node_anchor;
  }
  at[node] = was;
}

/// Moves a node by one step. Returns whether it isn't at rest yet.
bool SpringSolver::step(std::size_t node) {
  Vec3 move = balancing_step(node);
  const double max_length = kMaxStep * net_.size[node];
  // A node that turns back has overshot. A smaller factor ends the oscillation that very long or crushed elements cause.
  float& gain = gain_[node];
  gain = move.dot(last_step_[node]) < -kTurnBack * last_step_[node].squaredNorm() ? std::max(0.5F * gain, kMinGain)
                                                                                  : std::min(gain_recovery_ * gain, kMaxGain);
  move *= gain;
  const double length = move.norm();
  if (!std::isfinite(length)) return false;
  if (length > max_length) move *= max_length / length;
  const Vec3 was = at[node];
  limited[node] = 0;
  if (checked_[node] != 0) {
    step_checked(node, move);
  } else {
    step_freely(node, move);
  }
  last_step_[node] = at[node] - was;  // the move after projection and limit: both can turn it back
  return (at[node] - was).squaredNorm() > kAtRest * kAtRest * net_.size[node] * net_.size[node];
}

/// Moves a node in its tangent plane or along its tangent, and puts it back on the surface when it has drifted far enough.
void SpringSolver::step_freely(std::size_t node, const Vec3& move) {
  const Vec3 was = at[node];
  at[node] += move;
  if (const std::optional<double> limit = limit_of(node)) {
    const Vec3 away = at[node] - limit_origin(node);
    if (const double distance = away.norm(); distance > *limit) {
      at[node] = limit_origin(node) + away * (*limit / distance);
      limited[node] = 1;
    }
  }
  drift_[node] += static_cast<float>((at[node] - was).norm());
  if (!(drift_[node] > kMaxDrift * net_.size[node])) return;
  const Vec3 drifted = at[node];
  const double drift = drift_[node];
  return_to_surface(node);
  // Projection undid most of the move: the node pushes against the end of its sheet and would never come to rest.
  if ((at[node] - drifted).norm() > kMaxUndone * drift) checked_[node] = 1;
}

bool SpringSolver::return_all(const SolverCallbacks& callbacks) {
  const auto return_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (drift_[i] > 0) return_to_surface(i);
  };
  return parallel_for_interruptible(
      net_.movable, kSolverGrain, [&](double) { return callbacks.goes_on(); }, return_some);
}

/// Lets the guard check the shells. It moves the nodes of bad ones back; from then on their steps are checked.
SpringSolver::CheckResult SpringSolver::check(bool at_rest, const SolverCallbacks& callbacks) {
  if (at_rest && !return_all(callbacks)) return CheckResult::stopped;
  const auto put_near = [this](std::uint32_t node, const Vec3& point) {
    at[node] = point;
    return_to_surface(node);
  };
  const std::optional<QualityGuard::HeldBack> back = guard_.hold_back(last_accepted_, at, put_near, callbacks.goes_on);
  if (!back) return CheckResult::stopped;
  for (const std::uint32_t node : back->nodes) {
    held[node] = 1;
    last_step_[node] = Vec3::Zero();
  }
  for (const std::uint32_t shell : back->shells)
    for (const std::int32_t corner : net_.corners[shell])
      if (const auto node = static_cast<std::uint32_t>(corner); node < net_.movable) checked_[node] = active_[node] = 1;
  for (const std::uint32_t node : back->nodes)
    for (const Spring& spring : net_.springs_of(node))
      if (spring.to < net_.movable) active_[spring.to] = 1;
  last_accepted_ = at;
  return back->shells.empty() ? CheckResult::ok : CheckResult::bad_shells;
}

/// Moves a node if it is active and allowed to move. Returns whether it was.
bool SpringSolver::visit(std::uint32_t node, Spreading* spreading) {
  // Only visits to nodes of other colours set these flags for this node: no thread writes them now.
  if (active_[node] == 0 || (spreading != nullptr && spreading->allowed[node] == 0)) return false;
  active_[node] = 0;
  if (!step(node)) return true;
  const auto activate = [this](std::uint32_t other) { std::atomic_ref(active_[other]).store(1, std::memory_order_relaxed); };
  activate(node);
  const bool spreads = spreading != nullptr && (at[node] - net_.start[node]).squaredNorm() > spreading->threshold * spreading->threshold;
  for (const Spring& spring : net_.springs_of(node))
    if (spring.to < net_.movable) {
      activate(spring.to);
      if (spreads) std::atomic_ref(spreading->allowed[spring.to]).store(1, std::memory_order_relaxed);
    }
  return true;
}

/// Visits every node once, colour by colour. Returns how many were moved; nothing if stopped.
std::optional<std::size_t> SpringSolver::round(Spreading* spreading, const SolverCallbacks& callbacks) {
  std::atomic<std::size_t> stepped = 0;
  for (const std::vector<std::uint32_t>& colour : net_.colours) {
    const auto visit_some = [&](std::size_t begin, std::size_t end) {
      std::size_t here = 0;
      for (std::size_t i = begin; i < end; ++i) here += visit(colour[i], spreading) ? 1 : 0;
      stepped.fetch_add(here, std::memory_order_relaxed);
    };
    if (!parallel_for_interruptible(
            colour.size(), kSolverGrain, [&](double) { return callbacks.goes_on(); }, visit_some))
      return std::nullopt;
  }
  return stepped.load();
}

SolverResult SpringSolver::run(Spreading* spreading, const SolverCallbacks& callbacks) {
  SolverResult result;
  const auto stopped = [&result] {
    result.was_stopped = true;
    return result;
  };
  int next_check = kFirstCheck;
  while (result.rounds < options_.max_rounds) {
    if (result.rounds == kGainRecoveryRounds) gain_recovery_ = 1;
    const std::optional<std::size_t> stepped = round(spreading, callbacks);
    if (!stepped) return stopped();
    if (*stepped == 0) {
      const CheckResult found = check(true, callbacks);
      if (found == CheckResult::stopped) return stopped();
      result.converged = found == CheckResult::ok;
      if (result.converged) return result;
      continue;
    }
    ++result.rounds;
    if (!callbacks.round_done(1 - static_cast<double>(*stepped) / static_cast<double>(net_.movable))) return stopped();
    if (options_.checks_before_rest && result.rounds == next_check) {
      if (check(false, callbacks) == CheckResult::stopped) return stopped();
      next_check *= kChecksApart;
    }
  }
  result.was_stopped = check(true, callbacks) == CheckResult::stopped;
  return result;
}

}  // namespace prismesh::mesh::relax
