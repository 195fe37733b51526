#include "mesh/relax/spring_net.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/relax/feature_lines.h"
#include "mesh/relax/interruptible_loop.h"
#include "mesh/relax/sheet_fits.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kAnchorGrain = 128;
constexpr std::size_t kNetNodeGrain = 1024;
constexpr double kShareOfAnchors = 0.8;  ///< of the progress
constexpr int kSmoothings = 10;          ///< smoothing steps of the target lengths: how many elements far a long edge shares its length
constexpr double kSqrt2 = 1.4142135623730951;
constexpr std::uint32_t kNoNumber = std::numeric_limits<std::uint32_t>::max();

/// Local numbers by node of the model.
class LocalNumbers {
 public:
  explicit LocalNumbers(const Model& model) : number_(model.node_count(), kNoNumber) {}
  std::uint32_t of(NodeIndex node) const { return number_[node.value]; }
  std::uint32_t add(NodeIndex node, SpringNet& net) {
    std::uint32_t& number = number_[node.value];
    if (number == kNoNumber) {
      number = static_cast<std::uint32_t>(net.nodes.size());
      net.nodes.push_back(node);
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> number_;
};

void add_shells(const Model& model, LocalNumbers& numbers, SpringNet& net) {
  net.shells = shells_touching(model, NodeSet(net.nodes.begin(), net.nodes.end()));
  net.corners.resize(net.shells.size());
  for (std::size_t s = 0; s < net.shells.size(); ++s)
    for (std::size_t c = 0; c < 4; ++c) net.corners[s][c] = static_cast<std::int32_t>(numbers.add(model.shell(net.shells[s]).node[c], net));
}

/// Calls `add(other end, whether it is a diagonal)` for each spring of a shell at one of its corners.
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

/// Adds the springs of each movable node. Until sizes are known, `rest` is 1 for edges and the root of 2 for diagonals. Returns false if
/// cancelled.
bool add_springs(const Model& model, const LocalNumbers& numbers, const std::function<bool()>& goes_on, SpringNet& net) {
  net.first_spring.assign(1, 0);
  std::vector<Spring> own;
  for (std::size_t i = 0; i < net.movable; ++i) {
    if (i % kInterruptibleBlock == kInterruptibleBlock - 1 && !goes_on()) return false;
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

/// Replaces each movable node's size by the mean of it and its neighbours'.
void smooth_once(SpringNet& net, std::vector<double>& next) {
  parallel_for(net.movable, kNetNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = net.size[i];
      for (const Spring& spring : net.springs_of(i)) sum += net.size[spring.to];
      next[i] = sum / static_cast<double>(1 + net.springs_of(i).size());
    }
  });
  std::swap(net.size, next);
}

/// Total length of the springs over their total rest length, weighted.
double length_share(const SpringNet& net) {
  double is = 0, should_be = 0;
  for (std::size_t i = 0; i < net.movable; ++i)
    for (const Spring& spring : net.springs_of(i)) {
      is += spring.weight * (net.start[spring.to] - net.start[i]).norm();
      should_be += spring.weight * spring.rest;
    }
  return is > 0 && should_be > 0 ? is / should_be : 1;
}

/// Sets sizes and rest lengths. Sizes change slowly from node to node, so that stretched elements share their length with those about them.
/// They are the reference's at the node, not the mesh's own: relaxing again finds nearly the same, and a locally finer mesh stays so.
/// Returns false if cancelled.
bool set_lengths(const Model& model, const std::function<bool()>& goes_on, SpringNet& net) {
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

void colour(SpringNet& net) {
  std::vector<std::uint8_t> colour_of(net.movable, 64);
  for (std::size_t i = 0; i < net.movable; ++i) {
    std::uint64_t taken = 0;
    for (const Spring& spring : net.springs_of(i))
      if (spring.to < net.movable && colour_of[spring.to] < 64) taken |= std::uint64_t{1} << colour_of[spring.to];
    const int free = std::countr_one(taken);
    if (free >= 64) {
      net.anchor[i].freedom = Freedom::fixed;  // neighbours of 64 colours: no valid mesh
      continue;
    }
    colour_of[i] = static_cast<std::uint8_t>(free);
    if (net.colours.size() <= static_cast<std::size_t>(free)) net.colours.resize(static_cast<std::size_t>(free) + 1);
    net.colours[static_cast<std::size_t>(free)].push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace

Result<SpringNet> make_spring_net(const Model& model, const ReferenceSurface& surface, const NodeSet& movable, double feature_angle,
                                  const Progress& progress) {
  const double feature_cos = deterministic_cos_degrees(feature_angle);
  std::vector<SurfaceAnchor> anchors(movable.size());
  const auto find_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) anchors[i] = find_anchor(model, surface, movable[i], feature_cos);
  };
  const auto tell = [&](double fraction) { return !progress || progress(fraction); };
  if (!parallel_for_interruptible(
          movable.size(), kAnchorGrain, [&](double done) { return tell(kShareOfAnchors * done); }, find_some))
    return fail(cancelled());
  const auto goes_on = [&] { return tell(kShareOfAnchors); };
  if (!goes_on()) return fail(cancelled());
  SpringNet net;
  LocalNumbers numbers(model);
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
