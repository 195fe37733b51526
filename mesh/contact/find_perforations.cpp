#include "mesh/contact/find_perforations.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "mesh/contact/pair_regions.h"
#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

auto coordinates(const CurveSegment& s) { return std::tuple(s.from.x(), s.from.y(), s.from.z(), s.to.x(), s.to.y(), s.to.z()); }

/// Counts a segment once that several pairs of shells have.
void finish(Perforation& region) {
  std::sort(region.crossings.begin(), region.crossings.end());
  for (const auto& [a, b] : region.crossings) region.shells_a.push_back(a), region.shells_b.push_back(b);
  sort_unique(region.shells_a);
  sort_unique(region.shells_b);
  for (CurveSegment& s : region.curve)
    if (std::tuple(s.to.x(), s.to.y(), s.to.z()) < std::tuple(s.from.x(), s.from.y(), s.from.z())) std::swap(s.from, s.to);
  const auto less = [](const CurveSegment& x, const CurveSegment& y) { return coordinates(x) < coordinates(y); };
  const auto equal = [](const CurveSegment& x, const CurveSegment& y) { return coordinates(x) == coordinates(y); };
  std::sort(region.curve.begin(), region.curve.end(), less);
  region.curve.erase(std::unique(region.curve.begin(), region.curve.end(), equal), region.curve.end());
  for (const CurveSegment& segment : region.curve) region.length += segment.length();
}

}  // namespace

bool comes_first(const Perforation& x, const Perforation& y) {
  return std::tuple(-x.length, x.part_a, x.part_b, x.shells_a, x.shells_b) <
         std::tuple(-y.length, y.part_a, y.part_b, y.shells_a, y.shells_b);
}

std::vector<Perforation> group_crossings(const Model& model, const std::vector<ShellCrossing>& crossings) {
  std::vector<SidedPair> pairs;
  pairs.reserve(crossings.size());
  for (const ShellCrossing& crossing : crossings) pairs.push_back(in_order_of_parts(model, crossing.a, crossing.b));
  const std::vector<InRegion> regions = find_regions(model, pairs);

  std::vector<Perforation> found;
  std::vector<std::uint32_t> of_first(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [first, swapped] = regions[p];
    if (first == p) {
      of_first[p] = static_cast<std::uint32_t>(found.size());
      found.push_back({pairs[p].part_a, pairs[p].part_b, {}, {}, {}, {}, 0});
    }
    Perforation& region = found[of_first[first]];
    region.crossings.emplace_back(swapped ? pairs[p].b : pairs[p].a, swapped ? pairs[p].a : pairs[p].b);
    region.curve.insert(region.curve.end(), crossings[p].segments.begin(), crossings[p].segments.end());
  }
  for (Perforation& region : found) finish(region);
  std::sort(found.begin(), found.end(), [](const Perforation& x, const Perforation& y) { return comes_first(x, y); });
  return found;
}

std::vector<Perforation> find_perforations(const Model& model, const spatial::BoxTree& tree) {
  return group_crossings(model, find_shell_crossings(model, tree));
}

}  // namespace prismesh::mesh::contact
