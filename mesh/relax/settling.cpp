#include "mesh/relax/settling.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/relax/stretches.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kSettlingGrain = 512;
constexpr double kAtRest = 2e-3;       ///< of the size: a node that moves less in a round is at rest
constexpr double kMaxStep = 0.25;      ///< of the size, in a round
constexpr double kMaxDrift = 0.2;      ///< of the size: then a node is put back on the surface
constexpr float kMaxGain = 1.5F;       ///< steps go so far beyond the balance, which the neighbours follow
constexpr float kMinGain = 0.02F;      ///< and so far towards it where they turned back again and again
constexpr int kRecoveringRounds = 50;  ///< until then a node that turned back gathers pace again
constexpr double kSwing = 0.25;        ///< of the last step: going back farther is swinging, not settling
constexpr double kMaxInVain = 0.5;     ///< of its way, that being put back on the surface undoes: more, and the node leads nowhere
constexpr int kFirstCheck = 12;        ///< rounds until the guard looks first
constexpr int kChecksApart = 3;        ///< times as many rounds before each next time

/// Force along the directions a node may take, and how it grows with displacement there: 2x2, symmetric.
struct Pull {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

Pull pull_on(const Vec3& at, std::span<const Spring> springs, const std::vector<Vec3>& places, const Vec3& u, const Vec3& v) {
  Pull pull;
  for (const Spring& spring : springs) {
    const Vec3 d = places[spring.to] - at;
    const double length2 = d.squaredNorm();
    if (!(length2 > 0)) continue;
    const double stretch = 1 - spring.rest / std::sqrt(length2);
    const double du = d.dot(u), dv = d.dot(v);
    pull.u += spring.weight * stretch * du;
    pull.v += spring.weight * stretch * dv;
    // a compressed spring would give way sideways: that part is left out, so that the step leads downhill
    const double sideways = std::max(stretch, 0.0);
    const double along = spring.weight * (1 - sideways) / length2;
    pull.uu += spring.weight * sideways + along * du * du;
    pull.uv += along * du * dv;
    pull.vv += spring.weight * sideways + along * dv * dv;
  }
  return pull;
}

}  // namespace

Settling::Settling(const Net& net, const ReferenceSurface& surface, const Guard& guard, const Options& options)
    : at(net.start),
      anchor(net.anchor),
      limited(net.movable, 0),
      held(net.movable, 0),
      net_(net),
      surface_(surface),
      guard_(guard),
      options_(options),
      good_(net.start),
      last_(net.movable, Vec3::Zero()),
      gain_(net.movable, kMaxGain),
      drift_(net.movable, 0),
      awake_(net.movable, 1),
      careful_(net.movable, 0) {}

std::optional<double> Settling::limit_of(std::size_t node) const {
  return anchor[node].freedom == Freedom::line ? options_.most_on_line : options_.most_on_surface;
}

/// Where its limit counts from.
const Vec3& Settling::home_of(std::size_t node) const {
  return options_.limits_from != nullptr ? (*options_.limits_from)[net_.nodes[node].value] : net_.start[node];
}

/// Back on the surface, and within the limit.
void Settling::land(std::size_t node) {
  at[node] = put_back(surface_, at[node], anchor[node]);
  drift_[node] = 0;
  const std::optional<double> limit = limit_of(node);
  for (int i = 0; limit && i < 4; ++i) {
    const Vec3 move = at[node] - home_of(node);
    const double length = move.norm();
    if (!(length > *limit)) return;
    limited[node] = 1;
    at[node] = put_back(surface_, home_of(node) + move * (*limit / length * (1 - 1e-3 * i)), anchor[node]);
  }
  if (limit && (at[node] - home_of(node)).norm() > *limit) at[node] = net_.start[node];
}

/// To where the node's springs balance.
Vec3 Settling::balancing_step(std::size_t node) const {
  const SurfaceAnchor& foot = anchor[node];
  if (foot.freedom == Freedom::line) {
    const Pull pull = pull_on(at[node], net_.springs_of(node), at, foot.direction, Vec3::Zero());
    return pull.uu > 0 ? Vec3(pull.u / pull.uu * foot.direction) : Vec3::Zero();
  }
  int axis = 0;
  foot.direction.cwiseAbs().minCoeff(&axis);
  const Vec3 u = foot.direction.cross(Vec3::Unit(axis)).normalized();
  const Vec3 v = foot.direction.cross(u);
  Pull pull = pull_on(at[node], net_.springs_of(node), at, u, v);
  const double little = 1e-3 * (pull.uu + pull.vv);
  pull.uu += little;
  pull.vv += little;
  const double determinant = pull.uu * pull.vv - pull.uv * pull.uv;
  if (!(determinant > 0)) return Vec3::Zero();
  return ((pull.vv * pull.u - pull.uv * pull.v) * u + (pull.uu * pull.v - pull.uv * pull.u) * v) / determinant;
}

/// All of the way, a half or a quarter of it, or none.
void Settling::go_carefully(std::size_t node, const Vec3& move) {
  const Vec3 was = at[node];
  const SurfaceAnchor foot = anchor[node];
  held[node] = 0;
  for (const double share : {1.0, 0.5, 0.25}) {
    at[node] = was + share * move;
    land(node);
    if (guard_.allows(static_cast<std::uint32_t>(node), at[node], at)) return;
    held[node] = 1;
    anchor[node] = foot;
  }
  at[node] = was;
}

/// Returns whether the node is still on the move.
bool Settling::step(std::size_t node) {
  Vec3 move = balancing_step(node);
  const double most = kMaxStep * net_.size[node];
  // A node that turns back has gone too far: that ends what would swing for ever in meshes with very long or crushed elements.
  float& gain = gain_[node];
  gain =
      move.dot(last_[node]) < -kSwing * last_[node].squaredNorm() ? std::max(0.5F * gain, kMinGain) : std::min(recovery_ * gain, kMaxGain);
  move *= gain;
  const double length = move.norm();
  if (!std::isfinite(length)) return false;
  if (length > most) move *= most / length;
  const Vec3 was = at[node];
  limited[node] = 0;
  if (careful_[node] != 0) {
    go_carefully(node, move);
  } else {
    go(node, move);
  }
  last_[node] = at[node] - was;  // being put back or stopped at the limit turns it too
  return (at[node] - was).squaredNorm() > kAtRest * kAtRest * net_.size[node] * net_.size[node];
}

/// Along its tangent, and back on the surface now and then.
void Settling::go(std::size_t node, const Vec3& move) {
  const Vec3 was = at[node];
  at[node] += move;
  if (const std::optional<double> limit = limit_of(node)) {
    const Vec3 away = at[node] - home_of(node);
    if (const double distance = away.norm(); distance > *limit) {
      at[node] = home_of(node) + away * (*limit / distance);
      limited[node] = 1;
    }
  }
  drift_[node] += static_cast<float>((at[node] - was).norm());
  if (!(drift_[node] > kMaxDrift * net_.size[node])) return;
  const Vec3 drifted = at[node];
  const double drift = drift_[node];
  land(node);
  // Most of its way was off the surface: it pushes against the end of its sheet, and would go on for ever.
  if ((at[node] - drifted).norm() > kMaxInVain * drift) careful_[node] = 1;
}

bool Settling::land_all(const Watcher& watcher) {
  const auto land_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (drift_[i] > 0) land(i);
  };
  return parallel_in_stretches(
      net_.movable, kSettlingGrain, [&](double) { return watcher.goes_on(); }, land_some);
}

/// Whether there are shells that aren't as they may be. Their nodes have been taken back then, and go on with care.
Settling::Found Settling::check(bool at_rest, const Watcher& watcher) {
  if (at_rest && !land_all(watcher)) return Found::told_to_stop;
  const auto land_at = [this](std::uint32_t node, const Vec3& point) {
    at[node] = point;
    land(node);
  };
  const std::optional<Guard::Held> back = guard_.hold_back(good_, at, land_at, watcher.goes_on);
  if (!back) return Found::told_to_stop;
  for (const std::uint32_t node : back->nodes) {
    held[node] = 1;
    last_[node] = Vec3::Zero();
  }
  for (const std::uint32_t shell : back->shells)
    for (const std::int32_t corner : net_.corners[shell])
      if (const auto node = static_cast<std::uint32_t>(corner); node < net_.movable) careful_[node] = awake_[node] = 1;
  for (const std::uint32_t node : back->nodes)
    for (const Spring& spring : net_.springs_of(node))
      if (spring.to < net_.movable) awake_[spring.to] = 1;
  good_ = at;
  return back->shells.empty() ? Found::nothing : Found::bad_shells;
}

/// Lets a node step that is awake and may move. Returns whether it was.
bool Settling::visit(std::uint32_t node, Spreading* spreading) {
  // Only nodes of other colours wake this one or allow it: nobody does while it is asked.
  if (awake_[node] == 0 || (spreading != nullptr && spreading->allowed[node] == 0)) return false;
  awake_[node] = 0;
  if (!step(node)) return true;
  const auto wake = [this](std::uint32_t other) { std::atomic_ref(awake_[other]).store(1, std::memory_order_relaxed); };
  wake(node);
  const bool spreads = spreading != nullptr && (at[node] - net_.start[node]).squaredNorm() > spreading->threshold * spreading->threshold;
  for (const Spring& spring : net_.springs_of(node))
    if (spring.to < net_.movable) {
      wake(spring.to);
      if (spreads) std::atomic_ref(spreading->allowed[spring.to]).store(1, std::memory_order_relaxed);
    }
  return true;
}

/// Every node once, colour by colour. Returns how many had to step; nothing if told to stop.
std::optional<std::size_t> Settling::round(Spreading* spreading, const Watcher& watcher) {
  std::atomic<std::size_t> stepped = 0;
  for (const std::vector<std::uint32_t>& colour : net_.colours) {
    const auto visit_some = [&](std::size_t begin, std::size_t end) {
      std::size_t here = 0;
      for (std::size_t i = begin; i < end; ++i) here += visit(colour[i], spreading) ? 1 : 0;
      stepped.fetch_add(here, std::memory_order_relaxed);
    };
    if (!parallel_in_stretches(
            colour.size(), kSettlingGrain, [&](double) { return watcher.goes_on(); }, visit_some))
      return std::nullopt;
  }
  return stepped.load();
}

Settled Settling::run(Spreading* spreading, const Watcher& watcher) {
  Settled settled;
  const auto stopped = [&settled] {
    settled.was_stopped = true;
    return settled;
  };
  int next_check = kFirstCheck;
  while (settled.rounds < options_.most_rounds) {
    if (settled.rounds == kRecoveringRounds) recovery_ = 1;
    const std::optional<std::size_t> stepped = round(spreading, watcher);
    if (!stepped) return stopped();
    if (*stepped == 0) {
      const Found found = check(true, watcher);
      if (found == Found::told_to_stop) return stopped();
      settled.converged = found == Found::nothing;
      if (settled.converged) return settled;
      continue;
    }
    ++settled.rounds;
    if (!watcher.round_done(1 - static_cast<double>(*stepped) / static_cast<double>(net_.movable))) return stopped();
    if (options_.checks_on_the_way && settled.rounds == next_check) {
      if (check(false, watcher) == Found::told_to_stop) return stopped();
      next_check *= kChecksApart;
    }
  }
  settled.was_stopped = check(true, watcher) == Found::told_to_stop;
  return settled;
}

}  // namespace prismesh::mesh::relax
