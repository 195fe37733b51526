#include "mesh/relax/quality_guard.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/relax/interruptible_loop.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kGuardShellGrain = 1024;
constexpr std::size_t kGuardNodeGrain = 256;
constexpr int kHalvings = 3;  ///< of a node's move; then it goes back to where it was at the last check, and then to its start

bool is_triangle(const std::array<std::int32_t, 4>& corners) { return corners[3] == corners[2]; }

template <class PositionOf>
Vec3 normal_of(const std::array<std::int32_t, 4>& corners, const PositionOf& position_of) {
  const auto at = [&](std::size_t c) -> const Vec3& { return position_of(static_cast<std::uint32_t>(corners[c])); };
  if (is_triangle(corners)) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

auto in(const std::vector<Vec3>& positions) {
  return [&positions](std::uint32_t node) -> const Vec3& { return positions[node]; };
}

/// The share of its move since the last check that a node keeps after it has been moved back so many times.
double share_after(int times) { return times > kHalvings ? 0 : 1.0 / static_cast<double>(1 << times); }

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

template <class PositionOf, class Sink>
void QualityGuard::measure(std::span<const std::uint32_t> shells, const PositionOf& position_of, const Sink& sink) const {
  quality::measure_in_batches(
      shells.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        const std::array<std::int32_t, 4>& corners = net_.corners[shells[i]];
        for (std::size_t c = 0; c < 4; ++c) corner[c] = &position_of(static_cast<std::uint32_t>(corners[c]));
        return is_triangle(corners) ? quality::Shape::triangle : quality::Shape::quad;
      },
      [&](const quality::ShellBatch& batch, const quality::BatchValues& values) {
        quality::ShellProperties buffer[quality::kLanes];
        if (!properties_.empty())
          for (std::size_t lane = 0; lane < batch.count; ++lane) buffer[lane] = properties_[shells[batch.slot[lane]]];
        const quality::ShellProperties* properties = properties_.empty() ? nullptr : buffer;
        quality::ShellState states[quality::kLanes];
        float composites[quality::kLanes];
        quality::judge_lanes(values, batch.count, limits_, properties, states);
        quality::rate_lanes(values, batch.count, limits_, properties, composites);
        for (std::size_t lane = 0; lane < batch.count; ++lane) sink(batch.slot[lane], ShellQuality{states[lane], composites[lane]});
      });
}

template <class PositionOf>
bool QualityGuard::is_bad(std::uint32_t shell, const ShellQuality& verdict, const PositionOf& position_of) const {
  const bool new_mark = (verdict.state.fail & ~state_[shell].fail) != 0 || (verdict.state.warn & ~state_[shell].warn) != 0;
  if (new_mark || !(verdict.composite >= min_composite_[shell])) return true;
  return normal_of(net_.corners[shell], position_of).dot(normal_of(net_.corners[shell], in(net_.start))) < 0;  // turned over
}

QualityGuard::QualityGuard(const Model& model, const SpringNet& net, const quality::SizedCriteria& criteria)
    : net_(net), limits_(quality::limits_for(criteria)) {
  const std::size_t count = net.shells.size();
  if (limits_.need_properties()) {
    properties_.resize(count);
    for (std::size_t s = 0; s < count; ++s) properties_[s] = quality::properties_of(model, net.shells[s]);
  }
  state_.resize(count);
  min_composite_.resize(count);
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  parallel_for(count, kGuardShellGrain, [&](std::size_t begin, std::size_t end) {
    measure(std::span(all).subspan(begin, end - begin), in(net_.start), [&](std::size_t i, const ShellQuality& verdict) {
      state_[begin + i] = verdict.state;
      min_composite_[begin + i] = verdict.composite;
    });
  });
  // A shell that fails must not get worse. No other may get worse than the worst shell, or fail.
  const float worst = count > 0 ? std::max(*std::min_element(min_composite_.begin(), min_composite_.end()), 0.0F) : 0.0F;
  for (float& min : min_composite_) min = min < 0 ? min : std::min(min, worst);
  find_shells_of_nodes();
}

void QualityGuard::find_shells_of_nodes() {
  const auto each_corner = [&](const auto& use) {
    for (std::size_t s = 0; s < net_.corners.size(); ++s)
      for (std::size_t c = 0; c < (is_triangle(net_.corners[s]) ? 3u : 4u); ++c)
        if (const auto node = static_cast<std::uint32_t>(net_.corners[s][c]); node < net_.movable) use(node, static_cast<std::uint32_t>(s));
  };
  first_shell_.assign(net_.movable + 1, 0);
  each_corner([&](std::uint32_t node, std::uint32_t) { ++first_shell_[node + 1]; });
  std::partial_sum(first_shell_.begin(), first_shell_.end(), first_shell_.begin());
  shells_.resize(first_shell_.back());
  std::vector<std::uint32_t> next(first_shell_.begin(), first_shell_.end() - 1);
  each_corner([&](std::uint32_t node, std::uint32_t shell) { shells_[next[node]++] = shell; });
}

bool QualityGuard::allows(std::uint32_t node, const Vec3& position, const std::vector<Vec3>& positions) const {
  const auto position_of = [&](std::uint32_t n) -> const Vec3& { return n == node ? position : positions[n]; };
  const std::span<const std::uint32_t> shells = shells_of(node);
  bool all_well = true;
  measure(shells, position_of,
          [&](std::size_t i, const ShellQuality& verdict) { all_well = all_well && !is_bad(shells[i], verdict, position_of); });
  return all_well;
}

std::vector<std::uint8_t> QualityGuard::find_bad(std::span<const std::uint32_t> shells, const std::vector<Vec3>& positions) const {
  std::vector<std::uint8_t> bad(shells.size());
  parallel_for(shells.size(), kGuardShellGrain, [&](std::size_t begin, std::size_t end) {
    measure(shells.subspan(begin, end - begin), in(positions), [&](std::size_t i, const ShellQuality& verdict) {
      bad[begin + i] = is_bad(shells[begin + i], verdict, in(positions)) ? 1 : 0;
    });
  });
  return bad;
}

std::vector<std::uint32_t> QualityGuard::moved_shells(const std::vector<Vec3>& good, const std::vector<Vec3>& positions) const {
  std::vector<std::uint32_t> shells;
  for (std::uint32_t s = 0; s < net_.corners.size(); ++s)
    if (std::any_of(net_.corners[s].begin(), net_.corners[s].end(),
                    [&](std::int32_t n) { return positions[static_cast<std::size_t>(n)] != good[static_cast<std::size_t>(n)]; }))
      shells.push_back(s);
  return shells;
}

std::optional<QualityGuard::HeldBack> QualityGuard::hold_back(const std::vector<Vec3>& good, std::vector<Vec3>& positions,
                                                              const std::function<void(std::uint32_t, const Vec3&)>& put_near,
                                                              const std::function<bool()>& goes_on) const {
  HeldBack held;
  std::vector<std::uint32_t> shells = moved_shells(good, positions), back;
  std::vector<Vec3> wanted;
  std::vector<std::uint8_t> times(net_.movable, 0), is_listed(net_.movable, 0);
  while (!shells.empty()) {
    if (!goes_on()) return std::nullopt;
    const std::vector<std::uint8_t> bad = find_bad(shells, positions);
    back.clear();
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (bad[i] == 0) continue;
      held.shells.push_back(shells[i]);
      for (const std::int32_t corner : net_.corners[shells[i]])
        if (const auto n = static_cast<std::uint32_t>(corner); n < net_.movable && is_listed[n] == 0 && positions[n] != net_.start[n]) {
          is_listed[n] = 1;
          ++times[n];
          back.push_back(n);
        }
    }
    if (wanted.empty() && !back.empty()) wanted = positions;
    const auto take_back = [&](std::uint32_t n) {
      const bool to_start = times[n] > kHalvings + 1;
      put_near(n, to_start ? net_.start[n] : good[n] + share_after(times[n]) * (wanted[n] - good[n]));
      if (to_start) positions[n] = net_.start[n];  // to the bit
    };
    const auto take_some_back = [&](std::size_t begin, std::size_t end) { std::for_each(&back[begin], &back[0] + end, take_back); };
    if (!parallel_for_interruptible(
            back.size(), kGuardNodeGrain, [&](double) { return goes_on(); }, take_some_back))
      return std::nullopt;
    shells.clear();
    for (const std::uint32_t n : back) {
      is_listed[n] = 0;
      shells.insert(shells.end(), shells_of(n).begin(), shells_of(n).end());
    }
    sort_unique(shells);
  }
  sort_unique(held.shells);
  for (std::uint32_t n = 0; n < net_.movable; ++n)
    if (times[n] > 0) held.nodes.push_back(n);
  return held;
}

}  // namespace prismesh::mesh::relax
