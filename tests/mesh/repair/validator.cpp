#include "tests/mesh/repair/validator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Geometry>

namespace prismesh::mesh::repair {

namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;

struct Use {
  std::size_t shell;
  bool upwards;
};
using Edges = std::map<Key, std::vector<Use>>;

std::vector<std::uint32_t> ring(const Model& model, std::size_t shell) {
  std::vector<std::uint32_t> nodes;
  const ShellNodes& s = model.shell_nodes[shell];
  for (int i = 0; i < s.corners(); ++i) nodes.push_back(s.node[static_cast<std::size_t>(i)].value);
  return nodes;
}

Edges edges_of(const Model& model) {
  Edges edges;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    const auto nodes = ring(model, s);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto a = nodes[i], b = nodes[(i + 1) % nodes.size()];
      edges[{std::min(a, b), std::max(a, b)}].push_back({s, a < b});
    }
  }
  return edges;
}

Vec3 point(const Model& model, std::uint32_t node) { return model.positions[node]; }

Vec3 normal_of(const Model& model, std::size_t shell) {
  const auto n = ring(model, shell);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < n.size(); ++i)
    sum += (point(model, n[i]) - point(model, n[0])).cross(point(model, n[i + 1]) - point(model, n[0]));
  return sum;
}

struct DisjointSets {
  std::vector<std::size_t> parent;
  explicit DisjointSets(std::size_t size) : parent(size) { std::iota(parent.begin(), parent.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent[root(a)] = root(b); }
};

}  // namespace

Shape shape_of(const Model& model) {
  Shape shape;
  const Edges edges = edges_of(model);
  std::set<std::uint32_t> nodes, free_nodes;
  DisjointSets of_nodes(model.node_count()), of_shells(model.shell_count());
  long shells = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    ++shells;
    const auto around = ring(model, s);
    nodes.insert(around.begin(), around.end());
    for (std::size_t i = 1; i + 1 < around.size(); ++i)
      shape.area +=
          0.5 * (point(model, around[i]) - point(model, around[0])).cross(point(model, around[i + 1]) - point(model, around[0])).norm();
  }
  for (const auto& [key, uses] : edges) {
    const double length = (point(model, key.first) - point(model, key.second)).norm();
    shape.most_shells_an_edge = std::max(shape.most_shells_an_edge, uses.size());
    for (const Use& use : uses) of_shells.join(uses[0].shell, use.shell);
    if (uses.size() == 1) {
      shape.free_length += length;
      of_nodes.join(key.first, key.second);
      free_nodes.insert({key.first, key.second});
    } else if (uses.size() > 2) {
      shape.junction_length += length;
    } else {
      const Vec3 a = normal_of(model, uses[0].shell), b = normal_of(model, uses[1].shell);
      if (a.dot(b) < 0.5 * a.norm() * b.norm()) shape.crease_length += length;
      if (model.shell_parts[uses[0].shell] != model.shell_parts[uses[1].shell]) shape.border_length += length;
    }
  }
  shape.euler = static_cast<long>(nodes.size()) - static_cast<long>(edges.size()) + shells;
  std::set<std::size_t> loops, pieces;
  for (const auto node : free_nodes) loops.insert(of_nodes.root(node));
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (!model.is_removed(ShellIndex(s))) pieces.insert(of_shells.root(s));
  shape.free_loops = loops.size();
  shape.pieces = pieces.size();
  return shape;
}

std::string what_is_wrong(const Model& model) {
  std::set<std::vector<std::uint32_t>> seen;
  std::set<std::uint32_t> used;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    auto nodes = ring(model, s);
    for (const auto node : nodes) {
      if (node >= model.node_count() || model.is_removed(NodeIndex(std::size_t{node})))
        return "shell " + std::to_string(s) + " has a node that isn't there";
      used.insert(node);
    }
    std::sort(nodes.begin(), nodes.end());
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) return "shell " + std::to_string(s) + " repeats a node";
    if (!seen.insert(nodes).second) return "shell " + std::to_string(s) + " is there twice";
  }
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n)) && used.count(static_cast<std::uint32_t>(n)) == 0)
      return "node " + std::to_string(n) + " is of no shell";
  for (const auto& [key, uses] : edges_of(model))
    if (uses.size() == 2 && uses[0].upwards == uses[1].upwards)
      return "shells " + std::to_string(uses[0].shell) + " and " + std::to_string(uses[1].shell) + " are turned against each other";
  return {};
}

std::size_t triangle_pairs(const Model& model) {
  std::size_t pairs = 0;
  for (const auto& [key, uses] : edges_of(model))
    pairs += uses.size() == 2 && model.shell_nodes[uses[0].shell].is_triangle() && model.shell_nodes[uses[1].shell].is_triangle() ? 1 : 0;
  return pairs;
}

std::size_t triangles(const Model& model) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    count += !model.is_removed(ShellIndex(s)) && model.shell_nodes[s].is_triangle() ? 1 : 0;
  return count;
}

}  // namespace prismesh::mesh::repair
