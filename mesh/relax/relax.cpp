#include "mesh/relax/relax.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/relax/quality_guard.h"
#include "mesh/relax/spring_net.h"
#include "mesh/relax/spring_solver.h"

namespace prismesh::mesh::relax {

namespace {

constexpr double kShareOfNet = 0.25;  ///< of the progress
constexpr double kShareOfSolving = 0.7;
constexpr double kShareOfBlocks = 0.95;  ///< of the progress of a hierarchical relaxation
constexpr int kFirstRings = 6;           ///< of shells about the start's node, in the first block
constexpr double kMinMove = 1e-9;        ///< of the size: a smaller move is rounding; the node keeps its exact coordinates

bool goes_on(const Progress& progress, double fraction) { return !progress || progress(fraction); }

Relaxed gather(const SpringNet& net, const SpringSolver& solver, const SolverResult& result) {
  Relaxed relaxed;
  relaxed.rounds = result.rounds;
  relaxed.converged = result.converged;
  for (std::size_t i = 0; i < net.movable; ++i) {
    relaxed.held_back += solver.held[i];
    const double moved = (solver.at[i] - net.start[i]).norm();
    if (!(moved > kMinMove * net.size[i])) continue;
    relaxed.nodes.push_back(net.nodes[i]);
    relaxed.positions.push_back(solver.at[i]);
    relaxed.limited += solver.limited[i];
    relaxed.farthest = std::max(relaxed.farthest, moved);
  }
  return relaxed;
}

/// The solver's share of the progress, which never goes back.
class SolverProgress {
 public:
  explicit SolverProgress(const Progress& progress) : progress_(progress) {}
  bool round_done(double at_rest) {
    done_ = std::max(done_ + 0.02 * (1 - done_), at_rest);
    return goes_on_now();
  }
  bool goes_on_now() const { return goes_on(progress_, kShareOfNet + kShareOfSolving * std::min(done_, 1.0)); }

 private:
  const Progress& progress_;
  double done_ = 0;
};

/// The spring net, made within the first share of the progress.
Result<SpringNet> net_with_progress(const RelaxInput& input, const NodeSet& movable, const Progress& progress) {
  return make_spring_net(input.model, input.surface, movable, input.options.feature_angle,
                         [&](double fraction) { return goes_on(progress, kShareOfNet * fraction); });
}

/// Runs the solver with a guard. Errors: cancelled.
Result<Relaxed> solve(const RelaxInput& input, const SpringNet& net, Spreading* spreading, const Progress& progress) {
  if (!goes_on(progress, kShareOfNet)) return fail(cancelled());
  const QualityGuard guard(input.model, net, input.criteria);
  SpringSolver solver(net, input.surface, guard, input.options);
  SolverProgress solver_progress(progress);
  if (!solver_progress.goes_on_now()) return fail(cancelled());
  const SolverResult result = solver.run(
      spreading, {[&](double at_rest) { return solver_progress.round_done(at_rest); }, [&] { return solver_progress.goes_on_now(); }});
  if (result.was_stopped || !goes_on(progress, 1)) return fail(cancelled());
  return gather(net, solver, result);
}

/// Nodes of `movable` within some rings of shells about a node, ascending; `rim`: those of the last ring, ascending.
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

/// Allows the node and those about it.
std::vector<std::uint8_t> allowed_at_first(const Model& model, const SpringNet& net, NodeIndex at) {
  NodeSet around{at};
  for (const ShellIndex shell : model.adjacency->shells_of(at))
    around.insert(around.end(), model.shell(shell).node.begin(), model.shell(shell).node.end());
  std::sort(around.begin(), around.end());
  std::vector<std::uint8_t> allowed(net.movable);
  for (std::size_t i = 0; i < net.movable; ++i) allowed[i] = std::binary_search(around.begin(), around.end(), net.nodes[i]) ? 1 : 0;
  return allowed;
}

bool reaches_rim(const SpringNet& net, const Spreading& spreading, const NodeSet& rim) {
  for (std::size_t i = 0; i < net.movable; ++i)
    if (spreading.allowed[i] != 0 && std::binary_search(rim.begin(), rim.end(), net.nodes[i])) return true;
  return false;
}

}  // namespace

Result<Relaxed> relax(const RelaxInput& input, const NodeSet& movable, const Progress& progress) {
  if (!goes_on(progress, 0)) return fail(cancelled());
  const Result<SpringNet> net = net_with_progress(input, movable, progress);
  if (!net) return fail(net.error());
  return solve(input, *net, nullptr, progress);
}

Result<Relaxed> relax_from(const RelaxInput& input, const SpreadFrom& start, const NodeSet& movable, const Progress& progress) {
  if (!goes_on(progress, 0)) return fail(cancelled());
  double furthest = 0;  // a new start in a wider block doesn't take the progress back, and the end of a block isn't 100 %
  const Progress forward = [&](double fraction) { return goes_on(progress, furthest = std::max(furthest, kShareOfBlocks * fraction)); };
  // Relax a block about the node. When it turns out too small, start again with twice the rings.
  for (int rings = kFirstRings;; rings *= 2) {
    const Block block = block_about(input.model, start.node, rings, movable);
    const Result<SpringNet> net = net_with_progress(input, block.nodes, forward);
    if (!net) return fail(net.error());
    Spreading spreading{start.threshold, allowed_at_first(input.model, *net, start.node)};
    Result<Relaxed> relaxed = solve(input, *net, &spreading, forward);
    if (!relaxed) return relaxed;
    if (!block.rim.empty() && reaches_rim(*net, spreading, block.rim)) continue;
    if (!goes_on(progress, 1)) return fail(cancelled());
    return relaxed;
  }
}

}  // namespace prismesh::mesh::relax
