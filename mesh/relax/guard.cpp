#include "mesh/relax/guard.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/relax/stretches.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kGuardShellGrain = 1024;
constexpr std::size_t kGuardNodeGrain = 256;
constexpr int kHalvings = 3;  ///< then a node goes back to where it was when its shells were last looked at, and then to its start

bool is_triangle(const std::array<std::int32_t, 4>& corners) { return corners[3] == corners[2]; }

template <class PlaceOf>
Vec3 normal_of(const std::array<std::int32_t, 4>& corners, const PlaceOf& place_of) {
  const auto at = [&](std::size_t c) -> const Vec3& { return place_of(static_cast<std::uint32_t>(corners[c])); };
  if (is_triangle(corners)) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

auto in(const std::vector<Vec3>& places) {
  return [&places](std::uint32_t node) -> const Vec3& { return places[node]; };
}

/// Of its way since its shells were last looked at: what a node keeps that has been taken back so many times.
double share_after(int times) { return times > kHalvings ? 0 : 1.0 / static_cast<double>(1 << times); }

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

template <class PlaceOf, class Sink>
void Guard::measure(std::span<const std::uint32_t> shells, const PlaceOf& place_of, const Sink& sink) const {
  quality::measure_in_batches(
      shells.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        const std::array<std::int32_t, 4>& corners = net_.corners[shells[i]];
        for (std::size_t c = 0; c < 4; ++c) corner[c] = &place_of(static_cast<std::uint32_t>(corners[c]));
        return is_triangle(corners) ? quality::Shape::triangle : quality::Shape::quad;
      },
      [&](const quality::ShellBatch& batch, const quality::BatchValues& values) {
        quality::Sheet room[quality::kLanes];
        if (!sheets_.empty())
          for (std::size_t lane = 0; lane < batch.count; ++lane) room[lane] = sheets_[shells[batch.slot[lane]]];
        const quality::Sheet* sheets = sheets_.empty() ? nullptr : room;
        quality::ShellState states[quality::kLanes];
        float composites[quality::kLanes];
        quality::judge_lanes(values, batch.count, limits_, sheets, states);
        quality::rate_lanes(values, batch.count, limits_, sheets, composites);
        for (std::size_t lane = 0; lane < batch.count; ++lane) sink(batch.slot[lane], Verdict{states[lane], composites[lane]});
      });
}

template <class PlaceOf>
bool Guard::is_bad(std::uint32_t shell, const Verdict& verdict, const PlaceOf& place_of) const {
  const bool new_mark = (verdict.state.fail & ~state_[shell].fail) != 0 || (verdict.state.warn & ~state_[shell].warn) != 0;
  if (new_mark || !(verdict.composite >= least_[shell])) return true;
  return normal_of(net_.corners[shell], place_of).dot(normal_of(net_.corners[shell], in(net_.start))) < 0;  // turned over
}

Guard::Guard(const Model& model, const Net& net, const quality::SizedCriteria& criteria)
    : net_(net), limits_(quality::limits_for(criteria)) {
  const std::size_t count = net.shells.size();
  if (limits_.need_sheets()) {
    sheets_.resize(count);
    for (std::size_t s = 0; s < count; ++s) sheets_[s] = quality::sheet_of(model, net.shells[s]);
  }
  state_.resize(count);
  least_.resize(count);
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  parallel_for(count, kGuardShellGrain, [&](std::size_t begin, std::size_t end) {
    measure(std::span(all).subspan(begin, end - begin), in(net_.start), [&](std::size_t i, const Verdict& verdict) {
      state_[begin + i] = verdict.state;
      least_[begin + i] = verdict.composite;
    });
  });
  // One that fails doesn't get worse; of the others none becomes the new worst.
  const float worst = count > 0 ? std::max(*std::min_element(least_.begin(), least_.end()), 0.0F) : 0.0F;
  for (float& least : least_) least = least < 0 ? least : std::min(least, worst);
  find_shells_of_nodes();
}

void Guard::find_shells_of_nodes() {
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

bool Guard::allows(std::uint32_t node, const Vec3& place, const std::vector<Vec3>& places) const {
  const auto place_of = [&](std::uint32_t n) -> const Vec3& { return n == node ? place : places[n]; };
  const std::span<const std::uint32_t> shells = shells_of(node);
  bool all_well = true;
  measure(shells, place_of, [&](std::size_t i, const Verdict& verdict) { all_well = all_well && !is_bad(shells[i], verdict, place_of); });
  return all_well;
}

std::vector<std::uint8_t> Guard::find_bad(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places) const {
  std::vector<std::uint8_t> bad(shells.size());
  parallel_for(shells.size(), kGuardShellGrain, [&](std::size_t begin, std::size_t end) {
    measure(shells.subspan(begin, end - begin), in(places),
            [&](std::size_t i, const Verdict& verdict) { bad[begin + i] = is_bad(shells[begin + i], verdict, in(places)) ? 1 : 0; });
  });
  return bad;
}

std::vector<std::uint32_t> Guard::shells_off(const std::vector<Vec3>& good, const std::vector<Vec3>& places) const {
  std::vector<std::uint32_t> shells;
  for (std::uint32_t s = 0; s < net_.corners.size(); ++s)
    if (std::any_of(net_.corners[s].begin(), net_.corners[s].end(),
                    [&](std::int32_t n) { return places[static_cast<std::size_t>(n)] != good[static_cast<std::size_t>(n)]; }))
      shells.push_back(s);
  return shells;
}

std::optional<Guard::Held> Guard::hold_back(const std::vector<Vec3>& good, std::vector<Vec3>& places,
                                            const std::function<void(std::uint32_t, const Vec3&)>& land,
                                            const std::function<bool()>& goes_on) const {
  Held held;
  std::vector<std::uint32_t> shells = shells_off(good, places), back;
  std::vector<Vec3> wanted;
  std::vector<std::uint8_t> times(net_.movable, 0), is_listed(net_.movable, 0);
  while (!shells.empty()) {
    if (!goes_on()) return std::nullopt;
    const std::vector<std::uint8_t> bad = find_bad(shells, places);
    back.clear();
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (bad[i] == 0) continue;
      held.shells.push_back(shells[i]);
      for (const std::int32_t corner : net_.corners[shells[i]])
        if (const auto n = static_cast<std::uint32_t>(corner); n < net_.movable && is_listed[n] == 0 && places[n] != net_.start[n]) {
          is_listed[n] = 1;
          ++times[n];
          back.push_back(n);
        }
    }
    if (wanted.empty() && !back.empty()) wanted = places;
    const auto take_back = [&](std::uint32_t n) {
      const bool to_start = times[n] > kHalvings + 1;
      land(n, to_start ? net_.start[n] : good[n] + share_after(times[n]) * (wanted[n] - good[n]));
      if (to_start) places[n] = net_.start[n];  // to the bit
    };
    const auto take_some_back = [&](std::size_t begin, std::size_t end) { std::for_each(&back[begin], &back[0] + end, take_back); };
    if (!parallel_in_stretches(
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
