#include "mesh/contact/perforation_depth.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/contact/cut_pieces.h"
#include "mesh/contact/shell_area.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kDepthGrain = 256;

/// The area of the shells at nodes, in equal shares of each shell's corners.
double area_at(const Model& model, std::span<const NodeIndex> nodes) {
  double area = 0;
  for (const NodeIndex node : nodes)
    for (const ShellIndex shell : model.adjacency->shells_of(node)) area += area_of(model, shell) / model.shell(shell).corners();
  return area;
}

/// The shells of a part among which are the closest ones of all nodes. No node is farther from the part than from `known` shells of it.
ShellSet shells_about(const Model& model, const spatial::BoxTree& tree, PartIndex part, const ShellSet& known,
                      std::span<const NodeIndex> nodes) {
  const spatial::ShellTree known_tree(model, known);
  Eigen::AlignedBox3d box;
  double max_distance = 0;
  for (const NodeIndex node : nodes) {
    const auto closest = known_tree.closest(model.position(node));
    if (!closest) continue;
    box.extend(model.position(node));
    max_distance = std::max(max_distance, closest->distance);
  }
  if (box.isEmpty()) return known;
  ShellSet about;
  tree.near_box(box.min(), box.max(), max_distance, [&](ShellIndex shell, const spatial::FloatBox&) {
    if (model.shell_parts[shell.value] == part) about.push_back(shell);
    return true;
  });
  std::sort(about.begin(), about.end());
  return about;
}

double thickness_at(const Model& model, NodeIndex node) {
  float max = 0;
  for (const ShellIndex shell : model.adjacency->shells_of(node)) max = std::max(max, quality::thickness_of(model, shell.value));
  return max;
}

void measure(const Model& model, const spatial::ShellTree& other, double thickness_share, PerforationDepth& depth) {
  std::vector<double> of_node(depth.entering.size(), -1);
  depth.nearest.resize(of_node.size());
  parallel_for(of_node.size(), kDepthGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto closest = other.closest(model.position(depth.entering[i]));
      depth.nearest[i] = closest ? closest->point : model.position(depth.entering[i]);
      if (!closest) continue;
      const double thicknesses = thickness_at(model, depth.entering[i]) + quality::thickness_of(model, closest->shell.value);
      of_node[i] = closest->distance + thickness_share * thicknesses;
    }
  });
  const auto max = std::max_element(of_node.begin(), of_node.end());
  if (max == of_node.end() || *max < 0) return;
  depth.max = *max;
  depth.deepest = depth.entering[static_cast<std::size_t>(max - of_node.begin())];
  double sum = 0;
  std::size_t measured = 0;
  for (const double each : of_node)
    if (each >= 0) sum += each, ++measured;
  depth.mean = sum / static_cast<double>(measured);
}

PerforationDepth depth_of_piece(const Model& model, const spatial::BoxTree& tree, const Perforation& perforation, bool a_enters,
                                NodeSet entering, double thickness_share) {
  PerforationDepth depth;
  depth.a_enters = a_enters;
  depth.entering = std::move(entering);
  if (depth.entering.empty()) return depth;
  const ShellSet& crossed = a_enters ? perforation.shells_b : perforation.shells_a;
  const PartIndex other = a_enters ? perforation.part_b : perforation.part_a;
  const bool is_fold = perforation.part_a == perforation.part_b;
  measure(model, spatial::ShellTree(model, is_fold ? crossed : shells_about(model, tree, other, crossed, depth.entering)), thickness_share,
          depth);
  return depth;
}

PerforationDepth depth_of(const Model& model, const spatial::BoxTree& tree, const Perforation& perforation, double thickness_share) {
  std::vector<NodeIndex> of_a = cut_off_nodes(model, perforation, true), of_b = cut_off_nodes(model, perforation, false);
  const bool a_enters = !of_a.empty() && (of_b.empty() || area_at(model, of_a) <= area_at(model, of_b));
  PerforationDepth depth = depth_of_piece(model, tree, perforation, a_enters, std::move(a_enters ? of_a : of_b), thickness_share);
  depth.other_cut_off = std::move(a_enters ? of_b : of_a);
  return depth;
}

}  // namespace

std::vector<PerforationDepth> perforation_depths(const Model& model, const spatial::BoxTree& tree,
                                                 std::span<const Perforation> perforations, double thickness_share) {
  std::vector<PerforationDepth> depths(perforations.size());
  parallel_for(perforations.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) depths[i] = depth_of(model, tree, perforations[i], thickness_share);
  });
  return depths;
}

std::vector<EnteringPiece> entering_pieces(const Model& model, const spatial::BoxTree& tree, const Perforation& perforation) {
  std::vector<EnteringPiece> found, larger;
  for (const bool of_a : {true, false}) {
    CutPieces pieces = cut_pieces(model, perforation, of_a);
    if (pieces.cut_off.empty()) continue;
    found.push_back({depth_of_piece(model, tree, perforation, of_a, std::move(pieces.cut_off), 0), false});
    if (pieces.larger.empty()) continue;
    PerforationDepth depth = depth_of_piece(model, tree, perforation, of_a, std::move(pieces.larger), 0);
    if (depth.max < found.back().depth.max) larger.push_back({std::move(depth), true});
  }
  std::move(larger.begin(), larger.end(), std::back_inserter(found));
  return found;
}

}  // namespace prismesh::mesh::contact
