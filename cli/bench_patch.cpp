#include "cli/bench_patch.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/document/drag.h"
#include "mesh/document/prepare.h"
#include "mesh/model/node_set.h"

namespace prismesh::cli {

namespace {

namespace document = mesh::document;

constexpr std::array<std::size_t, 3> kSmallerPatches{600, 150, 40};  ///< tried in this order, then half of a connected piece
constexpr std::size_t kMaxPartsTried = 8;
constexpr int kMaxRings = 400;
/// How far the centre is lifted at most, in radii of the patch, and how many more shells should warn or fail then: enough for a repair to
/// measure, and few enough to end soon, since each costs some milliseconds or more.
constexpr double kMaxLift = 2;
constexpr double kSlideShare = 0.1;  ///< of the patch's radius that the centre slides
constexpr std::size_t kWantedDamaged = 20;
constexpr int kBisections = 12;

struct PartMiddle {
  std::size_t shells = 0;
  mesh::Vec3 sum = mesh::Vec3::Zero();  ///< of the first corners
  mesh::NodeIndex nearest;              ///< the first corner nearest to their mean
  double nearest_squared = std::numeric_limits<double>::infinity();
};

/// Of each part that has shells; the one with the most shells comes first.
std::vector<PartMiddle> part_middles(const mesh::Model& model) {
  std::vector<PartMiddle> middles(model.parts->size() + 1);  // the last one: shells without a part
  const auto each_corner = [&](const auto& body) {
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      if (model.is_removed(mesh::ShellIndex(s))) continue;
      const mesh::PartIndex part = model.shell_parts[s];
      const mesh::NodeIndex corner = model.shell_nodes[s].node[0];
      if (model.position(corner).allFinite()) body(part.valid() ? middles[part.value] : middles.back(), corner);
    }
  };
  each_corner([&](PartMiddle& middle, mesh::NodeIndex corner) {
    ++middle.shells;
    middle.sum += model.position(corner);
  });
  each_corner([&](PartMiddle& middle, mesh::NodeIndex corner) {
    const double squared = (model.position(corner) - middle.sum / static_cast<double>(middle.shells)).squaredNorm();
    if (squared >= middle.nearest_squared) return;
    middle.nearest_squared = squared;
    middle.nearest = corner;
  });
  std::erase_if(middles, [](const PartMiddle& middle) { return !middle.nearest.valid(); });
  std::stable_sort(middles.begin(), middles.end(), [](const PartMiddle& a, const PartMiddle& b) { return a.shells > b.shells; });
  if (middles.size() > kMaxPartsTried) middles.resize(kMaxPartsTried);
  return middles;
}

/// The deck with some rings of nodes around a centre selected.
struct Rings {
  document::Document selected;
  int count = 0;
  bool ended = false;  ///< the piece has no further ring
};

/// Selects as many rings as give the wanted number of nodes, or all rings of the piece. Errors: cancelled.
Result<Rings> select_rings(const document::Document& opened, mesh::NodeIndex centre, std::size_t wanted_nodes, int max_rings,
                           const Progress& progress) {
  Rings rings{opened, 0, false};
  document::Select select;
  select.expr = std::to_string(opened.current().model.node_ids[centre.value]);
  if (const auto done = document::apply(rings.selected, select); !done) return fail(done.error());
  while (rings.count < max_rings && rings.selected.current().selected_nodes < wanted_nodes) {
    if (progress && !progress(0)) return fail(cancelled());
    const std::size_t before = rings.selected.current().selected_nodes;
    if (const auto done = document::apply(rings.selected, document::Grow{}); !done) return fail(done.error());
    rings.ended = rings.selected.current().selected_nodes == before;
    if (rings.ended) break;
    ++rings.count;
  }
  return rings;
}

/// Selects the rings of a patch. Nothing: the piece is too small for the wanted number of nodes; a whole piece would move without bending.
/// `wanted_nodes` 0: half of the piece's rings, at least one.
Result<std::optional<document::Document>> with_patch_selected(const document::Document& opened, mesh::NodeIndex centre,
                                                              std::size_t wanted_nodes, const Progress& progress) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  Result<Rings> rings = select_rings(opened, centre, wanted_nodes > 0 ? wanted_nodes : kAll, kMaxRings, progress);
  if (rings && wanted_nodes == 0) rings = select_rings(opened, centre, kAll, std::max(1, rings->count / 2), progress);
  if (!rings) return fail(rings.error());
  if (wanted_nodes > 0 && rings->ended) return std::optional<document::Document>();
  return std::optional(std::move(rings->selected));
}

/// The smallest lift found by bisection at which the wanted number of shells, or as many as can, warn or fail that didn't before.
double damaging_distance(document::Drag& drag, double radius, const mesh::quality::Counts& before) {
  const auto damaged = [&](double distance) {
    drag.step({mesh::Vec3::Zero(), distance, 0});
    const std::size_t good = drag.counts().ok;
    return before.ok - std::min(before.ok, good);
  };
  double high = kMaxLift * radius, low = 0;
  const std::size_t wanted = std::min(kWantedDamaged, damaged(high));
  if (wanted == 0) return radius / 2;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (low + high);
    (damaged(middle) >= wanted ? high : low) = middle;
  }
  return high;
}

/// Nothing: see with_patch_selected. Errors: why the patch can't be lifted; cancelled.
Result<std::optional<BenchPatch>> try_patch(const document::Document& opened, mesh::NodeIndex centre, std::size_t wanted_nodes,
                                            const Progress& progress) {
  const Result<std::optional<document::Document>> found = with_patch_selected(opened, centre, wanted_nodes, progress);
  if (!found) return fail(found.error());
  if (!*found) return std::optional<BenchPatch>();
  const document::Document& selected = **found;
  const document::Generation& generation = selected.current();
  BenchPatch patch;
  patch.centre = centre;
  patch.selected = selected.generations[selected.cursor];
  patch.lift.shaping.grab = generation.model.node_ids[centre.value];
  Result<document::Drag> drag = document::Drag::begin(patch.selected, patch.lift);
  if (!drag) {
    const auto refused = document::prepare(selected, patch.lift);  // names the card as well
    return fail(refused ? drag.error() : refused.error());
  }
  patch.nodes = drag->nodes().size();
  patch.shells = drag->shells().size();
  mesh::Vec3 to_farthest = mesh::Vec3::Zero();
  for (const mesh::NodeIndex node : drag->nodes())
    if (const mesh::Vec3 to = generation.model.position(node) - generation.model.position(centre); to.norm() > to_farthest.norm())
      to_farthest = to;
  const double radius = to_farthest.norm();
  patch.slide_by = kSlideShare * to_farthest;
  patch.lift.distance = damaging_distance(*drag, radius, generation.counts);
  if (const auto lifted = document::prepare(selected, patch.lift); !lifted) return fail(lifted.error());
  return std::optional(std::move(patch));
}

}  // namespace

Result<BenchPatch> find_bench_patch(const document::Document& opened, std::size_t wanted_nodes, const Progress& progress) {
  const std::vector<PartMiddle> middles = part_middles(opened.current().model);
  if (middles.empty()) return fail("", std::string(kNoShells));
  BenchPatch unliftable;
  unliftable.centre = middles.front().nearest;
  std::vector<std::size_t> sizes{wanted_nodes};
  std::copy_if(kSmallerPatches.begin(), kSmallerPatches.end(), std::back_inserter(sizes),
               [&](std::size_t size) { return size < wanted_nodes; });
  sizes.push_back(0);
  for (const std::size_t size : sizes)
    for (const PartMiddle& middle : middles) {
      if (progress && !progress(0)) return fail(cancelled());
      Result<std::optional<BenchPatch>> patch = try_patch(opened, middle.nearest, size, progress);
      if (patch && *patch) return std::move(**patch);
      if (!patch && unliftable.refusal.empty()) unliftable.refusal = patch.error().text();
    }
  return unliftable;
}

}  // namespace prismesh::cli
