#include "mesh/relax/guard.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "base/parallel_for.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kShellsAtOnce = 1024;
constexpr int kHalvings = 3;  ///< then a node stays where it was

Vec3 normal_of(const std::array<std::int32_t, 4>& corners, const std::vector<Vec3>& places) {
  const auto at = [&](std::size_t c) -> const Vec3& { return places[static_cast<std::size_t>(corners[c])]; };
  if (corners[3] == corners[2]) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

}  // namespace

Guard::Guard(const Model& model, const Net& net, const Judge& judge) : net_(net), judge_(judge) {
  const std::size_t count = net.shells.size();
  sheets_.resize(count);
  for (std::size_t s = 0; s < count; ++s) sheets_[s] = quality::sheet_of(model, net.shells[s]);
  state_.resize(count);
  least_.resize(count);
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  rate(all, net.start, state_, least_);
  // One that fails doesn't get worse; of the others none becomes the new worst.
  const float worst = count > 0 ? std::max(*std::min_element(least_.begin(), least_.end()), 0.0F) : 0.0F;
  for (float& least : least_) least = least < 0 ? least : std::min(least, worst);
}

void Guard::rate(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places, std::span<quality::ShellState> states,
                 std::span<float> composites) const {
  parallel_for(shells.size(), kShellsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<std::int32_t, 4>> corners;
    std::vector<quality::Sheet> sheets;
    for (std::size_t i = begin; i < end; ++i) {
      corners.push_back(net_.corners[shells[i]]);
      sheets.push_back(sheets_[shells[i]]);
    }
    quality::judge_points(places, {}, corners, sheets, judge_.criteria, judge_.target_size, states.subspan(begin, end - begin),
                          composites.subspan(begin, end - begin));
  });
}

void Guard::judge(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places, std::span<std::uint8_t> is_bad) const {
  std::vector<quality::ShellState> states(shells.size());
  std::vector<float> composites(shells.size());
  rate(shells, places, states, composites);
  parallel_for(shells.size(), kShellsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t s = shells[i];
      const bool new_mark = (states[i].fail & ~state_[s].fail) != 0 || (states[i].warn & ~state_[s].warn) != 0;
      const bool turned_over = normal_of(net_.corners[s], places).dot(normal_of(net_.corners[s], net_.start)) < 0;
      is_bad[i] = new_mark || turned_over || !(composites[i] >= least_[s]) ? 1 : 0;
    }
  });
}

std::size_t Guard::hold_back(const ReferenceSurface& surface, std::vector<Vec3>& places, std::vector<Footing>& footing) const {
  const std::vector<Vec3> wanted = places;
  std::vector<std::uint8_t> halvings(net_.movable, 0), changed(net_.nodes.size(), 0);
  std::vector<std::uint32_t> shells(net_.shells.size());
  std::iota(shells.begin(), shells.end(), 0u);
  while (!shells.empty()) {
    std::vector<std::uint8_t> is_bad(shells.size());
    judge(shells, places, is_bad);
    std::vector<std::uint32_t> back;
    for (std::size_t i = 0; i < shells.size(); ++i)
      if (is_bad[i] != 0)
        for (const std::int32_t node : net_.corners[shells[i]])
          if (const auto n = static_cast<std::uint32_t>(node); n < net_.movable && changed[n] == 0 && places[n] != net_.start[n]) {
            changed[n] = 1;
            ++halvings[n];
            back.push_back(n);
          }
    parallel_for(back.size(), kShellsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t n = back[i];
        const double share = 1.0 / static_cast<double>(1 << halvings[n]);
        if (halvings[n] > kHalvings)
          places[n] = net_.start[n];
        else
          places[n] = put_back(surface, net_.start[n] + share * (wanted[n] - net_.start[n]), footing[n]);
      }
    });
    shells.clear();
    for (std::size_t s = 0; !back.empty() && s < net_.corners.size(); ++s)
      if (std::any_of(net_.corners[s].begin(), net_.corners[s].end(),
                      [&](std::int32_t n) { return changed[static_cast<std::size_t>(n)] != 0; }))
        shells.push_back(static_cast<std::uint32_t>(s));
    for (const std::uint32_t n : back) changed[n] = 0;
  }
  return static_cast<std::size_t>(std::count_if(halvings.begin(), halvings.end(), [](std::uint8_t h) { return h > 0; }));
}

}  // namespace prismesh::mesh::relax
