#include "mesh/contact/perforation_depth.h"

#include <algorithm>
#include <cstddef>
#include <map>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/contact/cut_pieces.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kDepthGrain = 256;

/// The area of the shells at nodes, in equal shares of each shell's corners.
double area_of(const Model& model, std::span<const NodeIndex> nodes) {
  double area = 0;
  for (const NodeIndex node : nodes)
    for (const ShellIndex shell : model.adjacency->shells_of(node)) {
      double of_shell = 0;
      each_shell_triangle(model, shell,
                          [&](const ShellTriangle& t) { of_shell += (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]).norm() / 2; });
      area += of_shell / model.shell(shell).corners();
    }
  return area;
}

/// The trees of parts, each made when it is first asked for.
class PartTrees {
 public:
  explicit PartTrees(const Model& model) : model_(model) {}

  const spatial::ShellTree& of(PartIndex part) {
    if (const auto at = trees_.find(part); at != trees_.end()) return at->second;
    ShellSet shells;
    for (std::size_t s = 0; s < model_.shell_count(); ++s)
      if (model_.shell_parts[s] == part && !model_.is_removed(ShellIndex(s))) shells.push_back(ShellIndex(s));
    return trees_.try_emplace(part, model_, shells).first->second;
  }

 private:
  const Model& model_;
  std::map<PartIndex, spatial::ShellTree> trees_;
};

double thickness_at(const Model& model, NodeIndex node) {
  float max = 0;
  for (const ShellIndex shell : model.adjacency->shells_of(node)) max = std::max(max, quality::thickness_of(model, shell.value));
  return max;
}

void measure(const Model& model, const spatial::ShellTree& other, double thickness_share, PerforationDepth& depth) {
  std::vector<double> of_node(depth.entering.size(), -1);
  parallel_for(of_node.size(), kDepthGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto closest = other.closest(model.position(depth.entering[i]));
      if (!closest) continue;
      const double thicknesses = thickness_at(model, depth.entering[i]) + quality::thickness_of(model, closest->shell.value);
      of_node[i] = closest->distance + thickness_share * thicknesses;
    }
  });
  const auto max = std::max_element(of_node.begin(), of_node.end());
  if (max == of_node.end() || *max < 0) return;
  depth.max = *max;
  depth.deepest = depth.entering[static_cast<std::size_t>(max - of_node.begin())];
}

}  // namespace

std::vector<PerforationDepth> perforation_depths(const Model& model, std::span<const Perforation> perforations, double thickness_share) {
  PartTrees trees(model);
  std::vector<PerforationDepth> depths;
  depths.reserve(perforations.size());
  for (const Perforation& perforation : perforations) {
    PerforationDepth& depth = depths.emplace_back();
    std::vector<NodeIndex> of_a = cut_off_nodes(model, perforation, true), of_b = cut_off_nodes(model, perforation, false);
    depth.a_enters = !of_a.empty() && (of_b.empty() || area_of(model, of_a) <= area_of(model, of_b));
    depth.entering = std::move(depth.a_enters ? of_a : of_b);
    if (depth.entering.empty()) continue;
    if (perforation.part_a == perforation.part_b)
      measure(model, spatial::ShellTree(model, depth.a_enters ? perforation.shells_b : perforation.shells_a), thickness_share, depth);
    else
      measure(model, trees.of(depth.a_enters ? perforation.part_b : perforation.part_a), thickness_share, depth);
  }
  return depths;
}

}  // namespace prismesh::mesh::contact
