#include "mesh/deck/editing/ancestors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace prismesh::mesh::deck {
namespace {

using Share = std::array<double, 4>;

/// Each ascending, so that a parent comes before its child.
struct Ancestors {
  std::vector<NodeIndex> added;  ///< with the node itself, if it was added
  std::vector<NodeIndex> deck;
};

void sort_unique(std::vector<NodeIndex>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

/// Without recursion: the number of generations has no limit.
Ancestors ancestors_of(const Model& model, std::vector<NodeIndex> waiting) {
  Ancestors out;
  while (!waiting.empty()) {
    // The largest index comes first, so that a node that waits twice comes twice in a row.
    std::pop_heap(waiting.begin(), waiting.end());
    const NodeIndex node = waiting.back();
    waiting.pop_back();
    if (!is_added(model, node)) {
      out.deck.push_back(node);
      continue;
    }
    if (!out.added.empty() && out.added.back() == node) continue;
    out.added.push_back(node);
    for (const NodeIndex parent : origin_of(model, node).parent)
      if (parent.valid()) {
        waiting.push_back(parent);
        std::push_heap(waiting.begin(), waiting.end());
      }
  }
  sort_unique(out.added);
  sort_unique(out.deck);
  return out;
}

NodeIndex example_among(const Model& model, const std::vector<NodeIndex>& deck) {
  for (auto node = deck.rbegin(); node != deck.rend(); ++node)
    if ((model.node_holds[node->value] & (kHeldByInclude | kHeldByMaking)) == 0) return *node;
  return {};
}

/// The shares of a shell's corners at a node that comes from these corners alone; nullopt: it comes from others too.
std::optional<Share> share_by_descent(const Model& model, const ShellNodes& corners, NodeIndex node) {
  const Ancestors ancestors = ancestors_of(model, {node});
  std::map<NodeIndex, Share> shares;
  for (const NodeIndex deck : ancestors.deck) {
    const auto end = corners.node.begin() + corners.corners();
    const auto corner = std::find(corners.node.begin(), end, deck);
    if (corner == end) return std::nullopt;
    Share unit{};
    unit[static_cast<std::size_t>(corner - corners.node.begin())] = 1;
    shares[deck] = unit;
  }
  for (const NodeIndex added : ancestors.added) {
    const NodeOrigin& origin = origin_of(model, added);
    Share mixed{};
    for (int p = 0; p < origin.count(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const Share& parent = shares[origin.parent[at]];
      for (std::size_t k = 0; k < 4; ++k) mixed[k] += origin.weight[at] * parent[k];
    }
    shares[added] = mixed;
  }
  return shares[node];
}

Share bilinear(double u, double v) { return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}; }

/// The shares of a shell's corners at its place nearest to a point: Gauss-Newton steps in the shell's own coordinates u and v, each kept
/// within the shell.
Share share_by_place(const std::array<Vec3, 4>& corners, bool triangle, const Vec3& point) {
  double u = 0.5, v = 0.5;
  for (int step = 0; step < 20; ++step) {
    const Share n = triangle ? Share{1 - u - v, u, v, 0} : bilinear(u, v);
    Vec3 at = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) at += n[k] * corners[k];
    Eigen::Matrix<double, 3, 2> slope;
    slope.col(0) = triangle ? Vec3(corners[1] - corners[0]) : Vec3((1 - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[3]));
    slope.col(1) = triangle ? Vec3(corners[2] - corners[0]) : Vec3((1 - u) * (corners[3] - corners[0]) + u * (corners[2] - corners[1]));
    const Eigen::Matrix2d square = slope.transpose() * slope;
    if (!(std::abs(square.determinant()) > 0)) break;
    const Eigen::Vector2d by = square.inverse() * (slope.transpose() * (point - at));
    if (!by.allFinite()) break;
    u = std::clamp(u + by[0], 0.0, 1.0);
    v = std::clamp(v + by[1], 0.0, 1.0);
    if (triangle && u + v > 1) {
      const double sum = u + v;
      u /= sum;
      v /= sum;
    }
    if (by.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return triangle ? Share{1 - u - v, u, v, 0} : bilinear(u, v);
}

/// The angle from one direction to another about a normal, in degrees, rounded to nine decimals so that 45 degrees are written as 45.
double turn_between(const Vec3& from, const Vec3& to, const Vec3& normal) {
  const double size = normal.norm();
  if (!(size > 0)) return 0;
  const Vec3 axis = normal / size;
  const Vec3 a = from - axis * axis.dot(from);
  const Vec3 b = to - axis * axis.dot(to);
  if (!(a.norm() > 0) || !(b.norm() > 0)) return 0;
  const double degrees = std::atan2(axis.dot(a.cross(b)), a.dot(b)) * 180 / M_PI;
  return std::round(degrees * 1e9) / 1e9;
}

}  // namespace

std::vector<NodeIndex> deck_ancestors(const Model& model, NodeIndex node) { return ancestors_of(model, {node}).deck; }

NodeIndex example_node(const Model& model, NodeIndex added) { return example_among(model, deck_ancestors(model, added)); }

NodeIndex example_node(const Model& model, const NodeOrigin& origin) {
  std::vector<NodeIndex> parents(origin.parent.begin(), origin.parent.begin() + origin.count());
  std::make_heap(parents.begin(), parents.end());
  return example_among(model, ancestors_of(model, std::move(parents)).deck);
}

ShellCard shell_card(const Model& original, const Model& model, ShellIndex shell) {
  const ShellNodes& ancestor = original.shell(deck_ancestor(model, shell));
  const ShellNodes& nodes = model.shell(shell);
  const bool triangle = ancestor.is_triangle();
  ShellCard card;
  card.id = model.shell_ids[shell.value];

  // The ancestor's corners where the saved model has them; a removed corner where it was last.
  std::array<Vec3, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = model.position(ancestor.node[k]);
  std::array<Vec3, 2> ends;
  for (std::size_t c = 0; c < 4; ++c) {
    card.nodes[c] = model.node_ids[nodes.node[c].value];
    const std::optional<Share> share = share_by_descent(model, ancestor, nodes.node[c]);
    card.share[c] = share ? *share : share_by_place(corners, triangle, model.position(nodes.node[c]));
    if (c > 1) continue;
    ends[c] = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) ends[c] += card.share[c][k] * corners[k];
    if (!share) ends[c] = model.position(nodes.node[c]);
  }
  const Vec3 normal = (corners[2] - corners[0]).cross((triangle ? corners[2] : corners[3]) - corners[1]);
  card.turn_degrees = turn_between(corners[1] - corners[0], ends[1] - ends[0], normal);
  return card;
}

}  // namespace prismesh::mesh::deck
