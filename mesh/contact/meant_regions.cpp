#include "mesh/contact/meant_regions.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "mesh/contact/find_perforations.h"
#include "mesh/contact/joints_of_parts.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::contact {

namespace {

bool any_of_set(const ShellSet& shells, const ShellSet* of) {
  return of == nullptr ||
         std::any_of(shells.begin(), shells.end(), [&](ShellIndex shell) { return std::binary_search(of->begin(), of->end(), shell); });
}

double max_thickness_among(const ContactThickness& thickness, const ShellSet& shells) {
  double max = 0;
  for (const ShellIndex shell : shells) max = std::max(max, thickness.of_shell[shell.value]);
  return max;
}

/// Half of both sides' thicknesses, and the gap.
double least_distance(const SeparationInput& input, const SeparationWish& wish, const MeantRegion& region) {
  return (max_thickness_among(input.thickness, region.shells[0]) + max_thickness_among(input.thickness, region.shells[1])) / 2 + wish.gap;
}

MeantRegion of_perforation(const SeparationInput& input, const SeparationWish& wish, const Perforation& found, PerforationDepth depth) {
  MeantRegion region;
  region.part = {found.part_a, found.part_b};
  region.shells = {found.shells_a, found.shells_b};
  region.perforation = found;
  region.depth = depth.max;
  region.least = least_distance(input, wish, region);
  let_enter(wish, std::move(depth), region);
  if (region.entering.empty()) region.why_left = "half through: nothing is cut off";
  if (!(region.least > 0))
    region.why_left = part_name(input.model, region.part[0]) +
                      (region.part[0] == region.part[1] ? "" : " and " + part_name(input.model, region.part[1])) +
                      (region.part[0] == region.part[1] ? " has" : " have") + " no thickness: say which gap is to be left";
  return region;
}

MeantRegion of_penetration(const SeparationWish& wish, const Penetration& found) {
  MeantRegion region;
  region.part = {found.part_a, found.part_b};
  region.shells = {found.shells_a, found.shells_b};
  region.depth = found.max_depth;
  region.way = found.max_depth - wish.allowed_depth;
  if (region.way <= 0) region.why_left = "no deeper than allowed_depth";
  return region;
}

double distance_from(const Model& model, const MeantRegion& region, const Vec3& at) {
  double distance = std::numeric_limits<double>::infinity();
  for (const ShellSet& shells : region.shells)
    if (const auto closest = spatial::ShellTree(model, shells).closest(at)) distance = std::min(distance, closest->distance);
  return distance;
}

void keep_nearest(const Model& model, const Vec3& at, std::vector<MeantRegion>& regions) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (const double distance = distance_from(model, regions[i], at); distance < least) least = distance, nearest = i;
  if (regions.empty()) return;
  MeantRegion kept = std::move(regions[nearest]);
  regions.assign(1, std::move(kept));
}

/// Whether the wish means the region, and which sides it lets move.
bool is_meant(const SeparationWish& wish, MeantRegion& region) {
  bool meant = false;
  std::array<bool, 2> is_on{}, is_against{};
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const bool fits = any_of_set(region.shells[side], wish.on) && any_of_set(region.shells[1 - side], wish.against);
    meant = meant || fits;
    is_on[side] = is_on[side] || fits;
    is_against[1 - side] = is_against[1 - side] || fits;
  }
  if (wish.move == MovingSide::on) region.may_move = is_on;
  if (wish.move == MovingSide::against) region.may_move = is_against;
  return meant;
}

}  // namespace

void let_enter(const SeparationWish& wish, PerforationDepth depth, MeantRegion& region) {
  region.upper = depth.a_enters ? 0 : 1;
  region.entering = std::move(depth.entering);
  region.way = depth.max.value_or(0) + region.least - std::min(wish.allowed_depth, region.least);
}

std::vector<MeantRegion> find_meant_regions(const SeparationInput& input, const SeparationWish& wish, const FoundContacts& contacts) {
  std::vector<MeantRegion> regions;
  if (wish.perforations) {
    const std::vector<Perforation> found = group_crossings(input.model, contacts.crossings);
    std::vector<PerforationDepth> depths = perforation_depths(input.model, input.tree, found, 0);
    for (std::size_t i = 0; i < found.size(); ++i) regions.push_back(of_perforation(input, wish, found[i], std::move(depths[i])));
    std::stable_sort(regions.begin(), regions.end(),
                     [](const MeantRegion& x, const MeantRegion& y) { return x.depth.value_or(0) > y.depth.value_or(0); });
  }
  if (wish.penetrations)
    for (const Penetration& found : contacts.penetrations) regions.push_back(of_penetration(wish, found));
  std::erase_if(regions, [&](MeantRegion& region) { return !is_meant(wish, region); });
  if (wish.at) keep_nearest(input.model, *wish.at, regions);
  const JointsOfParts joints(input.model, input.joints);
  for (MeantRegion& region : regions) {
    if (!region.why_left.empty()) continue;
    if (!wish.joined && joints.join_there(region.part[0], region.part[1], region.shells[0], region.shells[1], input.thickness))
      region.why_left = "the parts are joined there";
  }
  return regions;
}

}  // namespace prismesh::mesh::contact
