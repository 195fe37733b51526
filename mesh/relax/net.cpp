#include "mesh/relax/net.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/relax/feature_lines.h"
#include "mesh/relax/sheets.h"
#include "mesh/relax/stretches.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kNetFootingGrain = 128;
constexpr std::size_t kNetNodeGrain = 1024;
constexpr double kShareOfFootings = 0.8;  ///< of the progress
constexpr int kSmoothings = 10;           ///< of the sizes: how many elements away what is longer lends its length
constexpr double kSqrt2 = 1.4142135623730951;
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// Local numbers by the model's; made for one net.
class Numbers {
 public:
  explicit Numbers(const Model& model) : number_(model.node_count(), kNobody) {}
  std::uint32_t of(NodeIndex node) const { return number_[node.value]; }
  std::uint32_t add(NodeIndex node, Net& net) {
    std::uint32_t& number = number_[node.value];
    if (number == kNobody) {
      number = static_cast<std::uint32_t>(net.nodes.size());
      net.nodes.push_back(node);
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> number_;
};

void add_shells(const Model& model, Numbers& numbers, Net& net) {
  net.shells = shells_touching(model, NodeSet(net.nodes.begin(), net.nodes.end()));
  net.corners.resize(net.shells.size());
  for (std::size_t s = 0; s < net.shells.size(); ++s)
    for (std::size_t c = 0; c < 4; ++c) net.corners[s][c] = static_cast<std::int32_t>(numbers.add(model.shell(net.shells[s]).node[c], net));
}

/// A shell's springs at one of its corners go to `to`, each with its rest length as a multiple of an edge's.
template <class Add>
void springs_in(const ShellNodes& shell, NodeIndex node, const Add& add) {
  const int corners = shell.corners();
  for (int i = 0; i < corners; ++i) {
    if (shell.node[i] != node) continue;
    add(shell.node[next_corner(i, corners)], false);
    add(shell.node[previous_corner(i, corners)], false);
    if (corners == 4) add(shell.node[(i + 2) % 4], true);
    return;
  }
}

/// Springs of each movable node; `rest` is 1 for edges and the root of 2 for diagonals until sizes are known. Returns whether it was let.
bool add_springs(const Model& model, const Numbers& numbers, const std::function<bool()>& goes_on, Net& net) {
  net.first_spring.assign(1, 0);
  std::vector<Spring> own;
  for (std::size_t i = 0; i < net.movable; ++i) {
    if (i % kStretch == kStretch - 1 && !goes_on()) return false;
    own.clear();
    for (const ShellIndex shell : model.adjacency->shells_of(net.nodes[i]))
      springs_in(model.shell(shell), net.nodes[i], [&](NodeIndex other, bool is_diagonal) {
        const std::uint32_t to = numbers.of(other);
        const float rest = is_diagonal ? static_cast<float>(kSqrt2) : 1.0F;
        if (to == i || !net.start[to].allFinite()) return;
        const auto known = std::find_if(own.begin(), own.end(), [&](const Spring& s) { return s.to == to && s.rest == rest; });
        if (known != own.end())
          known->weight += 1;
        else
          own.push_back({to, 1, rest});
      });
    net.springs.insert(net.springs.end(), own.begin(), own.end());
    net.first_spring.push_back(static_cast<std::uint32_t>(net.springs.size()));
  }
  return true;
}

/// One more averaging of each movable node's size with its neighbours'.
void smooth_once(Net& net, std::vector<double>& next) {
  parallel_for(net.movable, kNetNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = net.size[i];
      for (const Spring& spring : net.springs_of(i)) sum += net.size[spring.to];
      next[i] = sum / static_cast<double>(1 + net.springs_of(i).size());
    }
  });
  std::swap(net.size, next);
}

/// How long the springs are beside what they should be, summed over all.
double length_share(const Net& net) {
  double is = 0, should_be = 0;
  for (std::size_t i = 0; i < net.movable; ++i)
    for (const Spring& spring : net.springs_of(i)) {
      is += spring.weight * (net.start[spring.to] - net.start[i]).norm();
      should_be += spring.weight * spring.rest;
    }
  return is > 0 && should_be > 0 ? is / should_be : 1;
}

/// Sizes that change slowly from node to node, so that what was stretched in one place shares it with its surroundings. They are the
/// reference's at the node's place, not the mesh's own: relaxing again finds nearly the same, and a mesh that is finer in places stays so.
bool set_lengths(const Model& model, const std::function<bool()>& goes_on, Net& net) {
  net.size.resize(net.nodes.size());
  parallel_for(net.nodes.size(), kNetNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) net.size[i] = i < net.movable ? net.anchor[i].size : mean_edge(model, net.nodes[i]);
  });
  std::vector<double> next = net.size;
  for (int round = 0; round < kSmoothings; ++round) {
    if (!goes_on()) return false;
    smooth_once(net, next);
  }
  for (std::size_t i = 0; i < net.movable; ++i)
    for (std::uint32_t s = net.first_spring[i]; s < net.first_spring[i + 1]; ++s)
      net.springs[s].rest *= static_cast<float>(0.5 * (net.size[i] + net.size[net.springs[s].to]));
  // Repairing may have made the mesh finer than the reference.
  const double share = length_share(net);
  for (Spring& spring : net.springs) spring.rest *= static_cast<float>(share);
  for (double& size : net.size) size *= share;
  return true;
}

void colour(Net& net) {
  std::vector<std::uint8_t> colour_of(net.movable, 64);
  for (std::size_t i = 0; i < net.movable; ++i) {
    std::uint64_t taken = 0;
    for (const Spring& spring : net.springs_of(i))
      if (spring.to < net.movable && colour_of[spring.to] < 64) taken |= std::uint64_t{1} << colour_of[spring.to];
    const int free = std::countr_one(taken);
    if (free >= 64) {
      net.anchor[i].freedom = Freedom::fixed;  // 64 neighbours that all differ: no mesh
      continue;
    }
    colour_of[i] = static_cast<std::uint8_t>(free);
    if (net.colours.size() <= static_cast<std::size_t>(free)) net.colours.resize(static_cast<std::size_t>(free) + 1);
    net.colours[static_cast<std::size_t>(free)].push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace

Result<Net> make_net(const Model& model, const ReferenceSurface& surface, const NodeSet& movable, double feature_angle,
                     const Progress& progress) {
  const double feature_cos = deterministic_cos_degrees(feature_angle);
  std::vector<SurfaceAnchor> anchors(movable.size());
  const auto find_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) anchors[i] = find_anchor(model, surface, movable[i], feature_cos);
  };
  const auto tell = [&](double fraction) { return !progress || progress(fraction); };
  if (!parallel_in_stretches(
          movable.size(), kNetFootingGrain, [&](double done) { return tell(kShareOfFootings * done); }, find_some))
    return fail(cancelled());
  const auto goes_on = [&] { return tell(kShareOfFootings); };
  if (!goes_on()) return fail(cancelled());
  Net net;
  Numbers numbers(model);
  for (std::size_t i = 0; i < movable.size(); ++i)
    if (anchors[i].freedom != Freedom::fixed) {
      numbers.add(movable[i], net);
      net.anchor.push_back(anchors[i]);
    }
  net.movable = net.nodes.size();
  add_shells(model, numbers, net);
  net.start.reserve(net.nodes.size());
  for (const NodeIndex node : net.nodes) net.start.push_back(model.position(node));
  if (!goes_on() || !add_springs(model, numbers, goes_on, net) || !set_lengths(model, goes_on, net)) return fail(cancelled());
  colour(net);
  return net;
}

}  // namespace prismesh::mesh::relax
