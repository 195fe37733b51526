#include "mesh/relax/relax.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/relax/guard.h"
#include "mesh/relax/net.h"
#include "mesh/relax/settling.h"

namespace prismesh::mesh::relax {

namespace {

constexpr double kShareOfNet = 0.25;  ///< of the progress, for finding out what is where
constexpr double kShareOfSettling = 0.7;
constexpr double kShareOfBlocks = 0.95;  ///< for a hierarchical relaxation in all blocks but the last
constexpr int kFirstRings = 6;           ///< about the node a hierarchical relaxation begins with
constexpr double kMinMove = 1e-9;        ///< of the size: less is rounding, and the node stays as it is to the bit

bool goes_on(const Progress& progress, double fraction) { return !progress || progress(fraction); }

Relaxed gather(const Net& net, const Settling& settling, const Settled& settled) {
  Relaxed relaxed;
  relaxed.rounds = settled.rounds;
  relaxed.converged = settled.converged;
  for (std::size_t i = 0; i < net.movable; ++i) {
    relaxed.held_back += settling.held[i];
    const double moved = (settling.at[i] - net.start[i]).norm();
    if (!(moved > kMinMove * net.size[i])) continue;
    relaxed.nodes.push_back(net.nodes[i]);
    relaxed.positions.push_back(settling.at[i]);
    relaxed.limited += settling.limited[i];
    relaxed.farthest = std::max(relaxed.farthest, moved);
  }
  return relaxed;
}

/// Progress that only grows, between the share that finding out took and that of the settling.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress) {}
  bool round_done(double at_rest) {
    done_ = std::max(done_ + 0.02 * (1 - done_), at_rest);
    return still_goes_on();
  }
  bool still_goes_on() const { return goes_on(progress_, kShareOfNet + kShareOfSettling * std::min(done_, 1.0)); }

 private:
  const Progress& progress_;
  double done_ = 0;
};

/// Of the first share of the progress.
Result<Net> find_net(const RelaxInput& input, const NodeSet& movable, const Progress& progress) {
  return make_net(input.model, input.surface, movable, input.options.feature_angle,
                  [&](double fraction) { return goes_on(progress, kShareOfNet * fraction); });
}

/// Settles, within what the guard allows.
Result<Relaxed> settle(const RelaxInput& input, const Net& net, Spreading* spreading, const Progress& progress) {
  if (!goes_on(progress, kShareOfNet)) return fail(cancelled());
  const Guard guard(input.model, net, input.criteria);
  Settling settling(net, input.surface, guard, input.options);
  Watch watch(progress);
  if (!watch.still_goes_on()) return fail(cancelled());
  const Settled settled =
      settling.run(spreading, {[&](double at_rest) { return watch.round_done(at_rest); }, [&] { return watch.still_goes_on(); }});
  if (settled.was_stopped || !goes_on(progress, 1)) return fail(cancelled());
  return gather(net, settling, settled);
}

/// Nodes of `movable` within so many shells of a node, ascending; `rim`: those of the last ring, ascending.
struct Block {
  NodeSet nodes;
  NodeSet rim;
};
Block block_about(const Model& model, NodeIndex at, int rings, const NodeSet& movable) {
  std::vector<std::uint8_t> is_known(model.node_count(), 0);
  is_known[at.value] = 1;
  NodeSet reached{at}, front{at};
  for (int ring = 0; ring < rings && !front.empty(); ++ring) {
    NodeSet next;
    for (const NodeIndex node : front)
      for (const ShellIndex shell : model.adjacency->shells_of(node))
        for (const NodeIndex other : model.shell(shell).node)
          if (std::exchange(is_known[other.value], std::uint8_t{1}) == 0 && std::binary_search(movable.begin(), movable.end(), other))
            next.push_back(other);
    reached.insert(reached.end(), next.begin(), next.end());
    front = std::move(next);
  }
  std::sort(reached.begin(), reached.end());
  std::sort(front.begin(), front.end());
  Block block;
  block.rim = std::move(front);
  std::set_intersection(reached.begin(), reached.end(), movable.begin(), movable.end(), std::back_inserter(block.nodes));
  return block;
}

/// The node and those around it.
std::vector<std::uint8_t> allowed_at_first(const Model& model, const Net& net, NodeIndex at) {
  NodeSet around{at};
  for (const ShellIndex shell : model.adjacency->shells_of(at))
    around.insert(around.end(), model.shell(shell).node.begin(), model.shell(shell).node.end());
  std::sort(around.begin(), around.end());
  std::vector<std::uint8_t> allowed(net.movable);
  for (std::size_t i = 0; i < net.movable; ++i) allowed[i] = std::binary_search(around.begin(), around.end(), net.nodes[i]) ? 1 : 0;
  return allowed;
}

bool reaches_rim(const Net& net, const Spreading& spreading, const NodeSet& rim) {
  for (std::size_t i = 0; i < net.movable; ++i)
    if (spreading.allowed[i] != 0 && std::binary_search(rim.begin(), rim.end(), net.nodes[i])) return true;
  return false;
}

}  // namespace

Result<Relaxed> relax(const RelaxInput& input, const NodeSet& movable, const Progress& progress) {
  if (!goes_on(progress, 0)) return fail(cancelled());
  const Result<Net> net = find_net(input, movable, progress);
  if (!net) return fail(net.error());
  return settle(input, *net, nullptr, progress);
}

Result<Relaxed> relax_from(const RelaxInput& input, const SpreadFrom& start, const NodeSet& movable, const Progress& progress) {
  if (!goes_on(progress, 0)) return fail(cancelled());
  double furthest = 0;  // beginning again in a wider block isn't less done, and the end of one isn't the end
  const Progress forward = [&](double fraction) { return goes_on(progress, furthest = std::max(furthest, kShareOfBlocks * fraction)); };
  // In a block about the node; where it turns out too small, again in one twice as wide.
  for (int rings = kFirstRings;; rings *= 2) {
    const Block block = block_about(input.model, start.node, rings, movable);
    const Result<Net> net = find_net(input, block.nodes, forward);
    if (!net) return fail(net.error());
    Spreading spreading{start.threshold, allowed_at_first(input.model, *net, start.node)};
    Result<Relaxed> relaxed = settle(input, *net, &spreading, forward);
    if (!relaxed) return relaxed;
    if (!block.rim.empty() && reaches_rim(*net, spreading, block.rim)) continue;
    if (!goes_on(progress, 1)) return fail(cancelled());
    return relaxed;
  }
}

}  // namespace prismesh::mesh::relax
