#include "mesh/contact/spread_lifts.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr int kSmoothings = 12;
constexpr double kMinShareOfLongest = 1e-3;  ///< shorter ones aren't spread

std::vector<NodeIndex> neighbours_of(const Model& model, NodeIndex node) {
  std::vector<NodeIndex> neighbours;
  for (const ShellIndex shell : model.adjacency->shells_of(node))
    for (const NodeIndex corner : model.shell(shell).node)
      if (corner != node) neighbours.push_back(corner);
  sort_unique(neighbours);
  return neighbours;
}

/// The longest first; of equal ones the first node.
struct Waiting {
  double length;
  NodeIndex node;
  bool operator<(const Waiting& other) const { return length != other.length ? length < other.length : other.node < node; }
};

Lifts cone_over(const Model& model, const Lifts& needed, double slope, const std::function<bool(NodeIndex)>& movable) {
  Lifts lifts = needed;
  std::priority_queue<Waiting> waiting;
  double longest = 0;
  for (const auto& [node, lift] : needed) waiting.push({lift.length, node}), longest = std::max(longest, lift.length);
  while (!waiting.empty()) {
    const Waiting from = waiting.top();
    waiting.pop();
    const Lift own = lifts.at(from.node);
    if (own.length != from.length) continue;
    for (const NodeIndex to : neighbours_of(model, from.node)) {
      const double length = from.length - slope * (model.position(to) - model.position(from.node)).norm();
      if (!(length > kMinShareOfLongest * longest)) continue;
      const auto known = lifts.find(to);
      if (known != lifts.end() ? known->second.length >= length : !movable(to)) continue;
      if (known != lifts.end())
        known->second.length = length;
      else
        lifts.emplace(to, Lift{length, own.direction});
      waiting.push({length, to});
    }
  }
  return lifts;
}

void smooth(const Model& model, const Lifts& needed, Lifts& lifts) {
  std::vector<NodeIndex> nodes;
  std::map<NodeIndex, std::size_t> place;
  for (const auto& [node, lift] : lifts) place.emplace(node, nodes.size()), nodes.push_back(node);
  struct About {
    std::vector<std::size_t> moving;
    double count = 0;  ///< of all neighbours
  };
  std::vector<About> about(nodes.size());
  std::vector<Lift> now(nodes.size());
  std::vector<double> least(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    now[i] = lifts.at(nodes[i]);
    if (const auto need = needed.find(nodes[i]); need != needed.end()) least[i] = need->second.length;
    for (const NodeIndex neighbour : neighbours_of(model, nodes[i])) {
      about[i].count += 1;
      if (const auto at = place.find(neighbour); at != place.end()) about[i].moving.push_back(at->second);
    }
  }
  for (int pass = 0; pass < kSmoothings; ++pass) {
    std::vector<Lift> next = now;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (about[i].count == 0) continue;
      double sum = 0;
      Vec3 direction = now[i].direction;
      for (const std::size_t j : about[i].moving) sum += now[j].length, direction += now[j].direction;
      next[i].length = std::max(least[i], (now[i].length + sum / about[i].count) / 2);
      if (direction.norm() > 1e-6) next[i].direction = direction.normalized();
    }
    now = std::move(next);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) lifts.at(nodes[i]) = now[i];
}

}  // namespace

Lifts spread_lifts(const Model& model, const Lifts& needed, double slope, const std::function<bool(NodeIndex)>& movable) {
  if (std::isinf(slope)) return needed;
  Lifts lifts = cone_over(model, needed, slope, movable);
  smooth(model, needed, lifts);
  return lifts;
}

}  // namespace prismesh::mesh::contact
