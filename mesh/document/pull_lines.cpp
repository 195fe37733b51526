#include "mesh/document/pull_lines.h"

#include "mesh/document/plan_motion.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

namespace {

constexpr double kWhole = 1 - 1e-9;  // weights carried across welds are interpolated
constexpr double kHalf = 0.5;

double weight_of(const Motion& motion, NodeIndex node) {
  const std::uint32_t place = motion.place_of(node);
  return place == Motion::Follower::kStays ? 0 : motion.weight[place];
}

std::vector<std::array<NodeIndex, 2>> find_followed(const Adjacency& adjacency, const Motion& motion) {
  std::vector<std::array<NodeIndex, 2>> edges;
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const NodeIndex node = motion.nodes[i];
    if (!(motion.weight[i] >= kWhole)) continue;
    for (std::uint32_t e = adjacency.edge_first[node.value]; e < adjacency.edge_first[node.value + 1]; ++e) {
      if (adjacency.edge_shell_first[e + 1] - adjacency.edge_shell_first[e] != 1) continue;
      if (weight_of(motion, adjacency.edge_high[e]) >= kWhole) edges.push_back({node, adjacency.edge_high[e]});
    }
  }
  return edges;
}

/// A shell's corners and their weights, in order around it.
struct WeightedShell {
  std::array<Vec3, 4> at;
  std::array<double, 4> weight{};
  std::size_t corners = 0;
};

/// The piece of the line in a shell, or the two pieces where opposite corners lie on the same side.
void add_halfway(const WeightedShell& shell, std::vector<std::array<Vec3, 2>>& pieces) {
  std::array<Vec3, 4> crossed;
  std::size_t count = 0;
  for (std::size_t c = 0; c < shell.corners; ++c) {
    const std::size_t next = (c + 1) % shell.corners;
    const double from = shell.weight[c], to = shell.weight[next];
    if ((from >= kHalf) != (to >= kHalf)) crossed[count++] = shell.at[c] + (shell.at[next] - shell.at[c]) * ((kHalf - from) / (to - from));
  }
  const auto add = [&](const Vec3& from, const Vec3& to) {
    if (from != to) pieces.push_back({from, to});  // where the line goes through a corner
  };
  if (count == 2) add(crossed[0], crossed[1]);
  if (count != 4) return;
  // Crossing c lies between corners c and c + 1. The middle says whether corners 1 and 3 or 0 and 2 are cut off.
  const double middle = (shell.weight[0] + shell.weight[1] + shell.weight[2] + shell.weight[3]) / 4;
  const std::size_t first = (middle >= kHalf) == (shell.weight[0] >= kHalf) ? 0 : 1;
  add(crossed[first], crossed[first + 1]);
  add(crossed[first + 2], crossed[(first + 3) % 4]);
}

std::vector<std::array<Vec3, 2>> find_halfway(const Model& model, const Motion& motion) {
  std::vector<std::array<Vec3, 2>> pieces;
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    if (!(motion.weight[i] >= kHalf)) continue;
    for (const ShellIndex index : model.adjacency->shells_of(motion.nodes[i])) {
      const ShellNodes nodes = model.shell(index);
      WeightedShell shell;
      shell.corners = static_cast<std::size_t>(nodes.corners());
      bool first = true;  // each shell once: with the first of its corners that is inside
      for (std::size_t c = 0; c < shell.corners; ++c) {
        shell.at[c] = model.position(nodes.node[c]);
        shell.weight[c] = weight_of(motion, nodes.node[c]);
        if (shell.weight[c] >= kHalf && nodes.node[c] < motion.nodes[i]) first = false;
      }
      if (first) add_halfway(shell, pieces);
    }
  }
  return pieces;
}

}  // namespace

Result<PullLines> find_pull_lines(const Generation& generation, const Edit& edit) {
  const Result<Motion> motion = plan_motion(generation, edit, nullptr);
  if (!motion) return fail(motion.error());
  return PullLines{find_followed(*generation.model.adjacency, *motion), find_halfway(generation.model, *motion)};
}

}  // namespace prismesh::mesh::document
