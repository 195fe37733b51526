#include "mesh/contact/find_penetrations.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/contact/close_shells.h"
#include "mesh/contact/pair_regions.h"
#include "mesh/contact/shell_area.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::contact {

namespace {

using Pairs = std::vector<CloseShells>;

std::vector<SidedPair> sided(const Model& model, const Pairs& pairs) {
  std::vector<SidedPair> result;
  result.reserve(pairs.size());
  for (const CloseShells& pair : pairs) result.push_back(in_order_of_parts(model, pair.a, pair.b));
  return result;
}

void leave_out_crossings(Pairs& pairs, const std::vector<ShellCrossing>& crossings) {
  std::erase_if(pairs, [&](const CloseShells& pair) {
    const auto at = std::lower_bound(crossings.begin(), crossings.end(), pair,
                                     [](const ShellCrossing& x, const CloseShells& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return at != crossings.end() && at->a == pair.a && at->b == pair.b;
  });
}

/// Leaves out edges that touch, and the shells that stand about them.
void leave_out_junctions(const Model& model, Pairs& pairs) {
  if (std::none_of(pairs.begin(), pairs.end(), [](const CloseShells& pair) { return pair.touch_at_edge; })) return;
  Pairs standing;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(standing), [](const CloseShells& pair) { return pair.stand; });
  const std::vector<InRegion> regions = find_regions(model, sided(model, standing));
  std::vector<std::uint8_t> is_junction(standing.size(), 0);  // by the region's first pair
  for (std::size_t p = 0; p < standing.size(); ++p)
    if (standing[p].touch_at_edge) is_junction[regions[p].first] = 1;
  std::size_t at = 0;  // pairs and standing have the same order
  std::erase_if(pairs, [&](const CloseShells& pair) {
    const bool of_junction = pair.stand && is_junction[regions[at].first] != 0;
    if (pair.stand) ++at;
    return of_junction || pair.touch_at_edge;
  });
}

bool is_selected(const CloseShells& pair, const ShellSet* selected) {
  const auto has = [&](ShellIndex shell) { return std::binary_search(selected->begin(), selected->end(), shell); };
  return selected == nullptr || has(pair.a) || has(pair.b);
}

/// The pairs of each region without a crossing.
std::vector<Penetration> group(const Model& model, const Pairs& pairs, const std::vector<ShellCrossing>& crossings,
                               const ShellSet* selected) {
  std::vector<SidedPair> all = sided(model, pairs);
  for (const ShellCrossing& crossing : crossings) all.push_back(in_order_of_parts(model, crossing.a, crossing.b));
  const std::vector<InRegion> regions = find_regions(model, all);
  std::vector<std::uint8_t> crosses(all.size(), 0);  // by the region's first pair
  for (std::size_t p = pairs.size(); p < all.size(); ++p) crosses[regions[p].first] = 1;
  constexpr auto kNone = static_cast<std::uint32_t>(-1);
  std::vector<Penetration> found;
  std::vector<std::uint32_t> of_first(all.size(), kNone);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [first, swapped] = regions[p];
    if (crosses[first] != 0 || !is_selected(pairs[p], selected)) continue;
    if (of_first[first] == kNone) {
      of_first[first] = static_cast<std::uint32_t>(found.size());
      found.emplace_back();
      found.back().part_a = all[p].part_a, found.back().part_b = all[p].part_b;
    }
    CloseShells pair = pairs[p];
    if ((all[p].a != pair.a) != swapped) std::swap(pair.a, pair.b), std::swap(pair.on_a, pair.on_b);
    found[of_first[first]].pairs.push_back(pair);
  }
  return found;
}

/// The greatest depth of each shell of a side, over its area.
double mean_depth(const Model& model, const ShellSet& shells, const Pairs& pairs, ShellIndex CloseShells::*side, double area) {
  std::vector<double> max(shells.size(), 0);
  for (const CloseShells& pair : pairs) {
    double& depth = max[static_cast<std::size_t>(std::lower_bound(shells.begin(), shells.end(), pair.*side) - shells.begin())];
    depth = std::max(depth, pair.depth);
  }
  double sum = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) sum += max[i] * area_of(model, shells[i]);
  return area > 0 ? sum / area : 0;
}

Vec3 normal_of(const Model& model, ShellIndex shell) {
  Vec3 normal = Vec3::Zero();
  each_shell_triangle(model, shell, [&](const ShellTriangle& t) { normal += (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]); });
  return normal.normalized();
}

std::vector<WayOut> ways_out(const Model& model, const ContactThickness& thickness, double gap, const ShellSet& own,
                             const ShellSet& other) {
  std::map<NodeIndex, ShellIndex> thickest_at;
  for (const ShellIndex shell : own)
    for (const NodeIndex node : model.shell(shell).node) {
      ShellIndex& at = thickest_at.emplace(node, shell).first->second;
      if (thickness.of_shell[shell.value] > thickness.of_shell[at.value]) at = shell;
    }
  const spatial::ShellTree tree(model, other);
  std::vector<WayOut> ways;
  std::vector<ShellIndex> closest_shell;
  Vec3 whole = Vec3::Zero();  // the side on which the nodes are
  for (const auto& [node, thickest] : thickest_at) {
    const Vec3& point = model.position(node);
    const auto closest = tree.closest(point);
    if (!closest) continue;
    const double mean = thickness.between(thickest, closest->shell);
    const double depth = mean + gap - closest->distance;
    if (!(depth > kMinDepthShare * mean)) continue;
    const Vec3 away = point - closest->point;
    whole += away;
    const bool on_it = closest->distance <= kMinDepthShare * mean;
    ways.push_back({node, on_it ? normal_of(model, closest->shell) : Vec3(away.normalized()), depth});
    closest_shell.push_back(on_it ? closest->shell : ShellIndex{});
  }
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (closest_shell[i].valid() && ways[i].direction.dot(whole) < 0) ways[i].direction = -ways[i].direction;
  return ways;
}

void finish(const Model& model, const ContactThickness& thickness, double gap, Penetration& region) {
  std::sort(region.pairs.begin(), region.pairs.end(),
            [](const CloseShells& x, const CloseShells& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  for (const CloseShells& pair : region.pairs) region.shells_a.push_back(pair.a), region.shells_b.push_back(pair.b);
  sort_unique(region.shells_a);
  sort_unique(region.shells_b);
  region.worst = *std::max_element(region.pairs.begin(), region.pairs.end(),
                                   [](const CloseShells& x, const CloseShells& y) { return x.depth < y.depth; });
  region.max_depth = region.worst.depth;
  const double area_a = area_of(model, region.shells_a), area_b = area_of(model, region.shells_b);
  region.area = std::min(area_a, area_b);
  region.mean_depth = area_b < area_a ? mean_depth(model, region.shells_b, region.pairs, &CloseShells::b, area_b)
                                      : mean_depth(model, region.shells_a, region.pairs, &CloseShells::a, area_a);
  region.is_clearance = std::all_of(region.pairs.begin(), region.pairs.end(), [&](const CloseShells& pair) {
    return pair.depth - gap <= kMinDepthShare * (pair.distance + pair.depth - gap);
  });
  region.nodes_a = ways_out(model, thickness, gap, region.shells_a, region.shells_b);
  region.nodes_b = ways_out(model, thickness, gap, region.shells_b, region.shells_a);
}

}  // namespace

bool comes_first(const Penetration& x, const Penetration& y) {
  return std::tuple(-x.max_depth, x.part_a, x.part_b, x.shells_a, x.shells_b) <
         std::tuple(-y.max_depth, y.part_a, y.part_b, y.shells_a, y.shells_b);
}

std::vector<Penetration> group_close_shells(const Model& model, const ContactThickness& thickness, std::vector<CloseShells> pairs,
                                            const std::vector<ShellCrossing>& crossings, double gap, const ShellSet* selected) {
  leave_out_crossings(pairs, crossings);
  leave_out_junctions(model, pairs);
  std::vector<Penetration> found = group(model, pairs, crossings, selected);
  parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) finish(model, thickness, gap, found[i]);
  });
  std::sort(found.begin(), found.end(), [](const Penetration& x, const Penetration& y) { return comes_first(x, y); });
  return found;
}

std::vector<Penetration> find_penetrations(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness,
                                           const std::vector<ShellCrossing>& crossings, const PenetrationWish& wish,
                                           const Progress& progress) {
  return group_close_shells(model, thickness, find_close_shells(model, tree, thickness, wish.gap, wish.among, progress), crossings,
                            wish.gap, wish.selected);
}

}  // namespace prismesh::mesh::contact
