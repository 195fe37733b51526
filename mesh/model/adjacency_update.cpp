#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/large_memory.h"
#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/edge_uses.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh {

namespace {

constexpr std::size_t kUpdateGrain = 65536;
/// If more than one in so many nodes is touched, building anew is as fast.
constexpr std::size_t kFewNodes = 8;

/// The rows of the nodes whose rows differ ("dirty"), and how far they shift the rows after them.
struct DirtyRows {
  std::vector<NodeIndex> nodes;  ///< ascending
  // of each: where its row begins in the arrays below, one more at the end
  std::vector<std::uint32_t> shell_first, edge_first;
  std::vector<ShellIndex> shells;
  std::vector<NodeIndex> edge_high;
  std::vector<std::uint32_t> use_first;  ///< of each edge, one more at the end
  std::vector<ShellIndex> edge_shells;
  // before each, and one more at the end: what its row and all earlier ones add to where old rows began
  std::vector<std::int64_t> shell_shift, edge_shift, use_shift;
};

struct Incidence {
  NodeIndex node;
  ShellIndex shell;
  auto operator<=>(const Incidence&) const = default;
};

void sort_unique(auto& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Shells that were added or removed or have other corners, ascending.
ShellSet changed_shells(const Changes& changes) {
  ShellSet shells = changes.removed_shells;
  shells.insert(shells.end(), changes.added_shells.begin(), changes.added_shells.end());
  shells.insert(shells.end(), changes.reshaped_shells.begin(), changes.reshaped_shells.end());
  sort_unique(shells);
  return shells;
}

void add_corners(const Model& model, const ShellSet& shells, std::vector<Incidence>& incidences) {
  for (const ShellIndex shell : shells) {
    if (shell.value >= model.shell_count()) continue;
    const Corners corners = distinct_corners(model.shell(shell));
    for (int i = 0; i < corners.count; ++i) incidences.push_back({corners.node[static_cast<std::size_t>(i)], shell});
  }
}

/// Nodes that a changed shell has or had, and all new ones.
std::vector<NodeIndex> dirty_nodes(const Model& before, const Model& after, const ShellSet& changed,
                                   const std::vector<Incidence>& incidences) {
  std::vector<NodeIndex> nodes;
  std::vector<Incidence> had;
  add_corners(before, changed, had);
  for (const Incidence& each : had) nodes.push_back(each.node);
  for (const Incidence& each : incidences) nodes.push_back(each.node);
  for (std::size_t n = before.node_count(); n < after.node_count(); ++n) nodes.emplace_back(n);
  sort_unique(nodes);
  return nodes;
}

DirtyRows dirty_rows(const Model& before, const Model& after, const ShellSet& changed, const std::vector<Incidence>& incidences,
                     std::vector<NodeIndex> nodes) {
  const Adjacency& old = *before.adjacency;
  DirtyRows rows;
  rows.nodes = std::move(nodes);
  rows.shell_shift = rows.edge_shift = rows.use_shift = {0};
  std::vector<EdgeUse> uses;
  auto incidence = incidences.begin();
  for (const NodeIndex node : rows.nodes) {
    const std::size_t shells_begin = rows.shells.size(), edges_begin = rows.edge_high.size(), uses_begin = rows.edge_shells.size();
    rows.shell_first.push_back(static_cast<std::uint32_t>(shells_begin));
    rows.edge_first.push_back(static_cast<std::uint32_t>(edges_begin));
    std::int64_t old_shells = 0, old_edges = 0, old_uses = 0;
    if (node.value < before.node_count()) {
      for (const ShellIndex shell : old.shells_of(node))
        if (!std::binary_search(changed.begin(), changed.end(), shell)) rows.shells.push_back(shell);
      old_shells = static_cast<std::int64_t>(old.shells_of(node).size());
      old_edges = old.edge_first[node.value + 1] - old.edge_first[node.value];
      old_uses = old.edge_shell_first[old.edge_first[node.value + 1]] - old.edge_shell_first[old.edge_first[node.value]];
    }
    for (; incidence != incidences.end() && incidence->node == node; ++incidence) rows.shells.push_back(incidence->shell);
    const auto begin = rows.shells.begin() + static_cast<std::ptrdiff_t>(shells_begin);
    std::sort(begin, rows.shells.end());
    collect_uses(after, std::span(rows.shells).subspan(shells_begin), node, uses);
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (i == 0 || uses[i].high != uses[i - 1].high) {
        rows.edge_high.push_back(uses[i].high);
        rows.use_first.push_back(static_cast<std::uint32_t>(rows.edge_shells.size()));
      }
      rows.edge_shells.push_back(uses[i].shell);
    }
    rows.shell_shift.push_back(rows.shell_shift.back() + static_cast<std::int64_t>(rows.shells.size() - shells_begin) - old_shells);
    rows.edge_shift.push_back(rows.edge_shift.back() + static_cast<std::int64_t>(rows.edge_high.size() - edges_begin) - old_edges);
    rows.use_shift.push_back(rows.use_shift.back() + static_cast<std::int64_t>(rows.edge_shells.size() - uses_begin) - old_uses);
  }
  rows.shell_first.push_back(static_cast<std::uint32_t>(rows.shells.size()));
  rows.edge_first.push_back(static_cast<std::uint32_t>(rows.edge_high.size()));
  rows.use_first.push_back(static_cast<std::uint32_t>(rows.edge_shells.size()));
  return rows;
}

/// The entries [begin, end) of an array.
struct Run {
  std::size_t begin = 0;
  std::size_t end = 0;
};

template <class T>
void copy_run(const std::vector<T>& from, Run run, std::vector<T>& to, std::size_t at) {
  std::copy(from.begin() + static_cast<std::ptrdiff_t>(run.begin), from.begin() + static_cast<std::ptrdiff_t>(run.end),
            to.begin() + static_cast<std::ptrdiff_t>(at));
}

/// The same with a number added to each.
void copy_shifted(const std::vector<std::uint32_t>& from, Run run, std::int64_t shift, std::vector<std::uint32_t>& to, std::size_t at) {
  const auto by = static_cast<std::uint32_t>(shift);  // a negative shift wraps around
  for (std::size_t i = run.begin; i < run.end; ++i) to[at + (i - run.begin)] = from[i] + by;
}

/// Rows of nodes of which none is dirty; `d` dirty ones are before them.
void copy_clean(const Adjacency& old, const DirtyRows& rows, std::size_t d, Run nodes, Adjacency& out) {
  if (nodes.begin >= nodes.end) return;
  const Run shells{old.node_first[nodes.begin], old.node_first[nodes.end]};
  const Run edges{old.edge_first[nodes.begin], old.edge_first[nodes.end]};
  const Run uses{old.edge_shell_first[edges.begin], old.edge_shell_first[edges.end]};
  const auto moved = [](std::size_t at, std::int64_t shift) { return static_cast<std::size_t>(static_cast<std::int64_t>(at) + shift); };
  const std::size_t edges_at = moved(edges.begin, rows.edge_shift[d]);
  copy_shifted(old.node_first, nodes, rows.shell_shift[d], out.node_first, nodes.begin);
  copy_run(old.node_shells, shells, out.node_shells, moved(shells.begin, rows.shell_shift[d]));
  copy_shifted(old.edge_first, nodes, rows.edge_shift[d], out.edge_first, nodes.begin);
  copy_run(old.edge_high, edges, out.edge_high, edges_at);
  copy_shifted(old.edge_shell_first, edges, rows.use_shift[d], out.edge_shell_first, edges_at);
  copy_run(old.edge_shells, uses, out.edge_shells, moved(uses.begin, rows.use_shift[d]));
}

void put_dirty(const Adjacency& old, const DirtyRows& rows, std::size_t d, Adjacency& out) {
  const std::size_t node = rows.nodes[d].value;
  const std::size_t row = std::min(node, old.node_first.size() - 1);  // a new node's row begins where the old table ends
  const auto moved = [](std::size_t at, std::int64_t shift) { return static_cast<std::size_t>(static_cast<std::int64_t>(at) + shift); };
  const std::size_t shells = moved(old.node_first[row], rows.shell_shift[d]);
  const std::size_t edges = moved(old.edge_first[row], rows.edge_shift[d]);
  const std::size_t uses = moved(old.edge_shell_first[old.edge_first[row]], rows.use_shift[d]);
  out.node_first[node] = static_cast<std::uint32_t>(shells);
  out.edge_first[node] = static_cast<std::uint32_t>(edges);
  const Run edge_run{rows.edge_first[d], rows.edge_first[d + 1]};
  const Run use_run{rows.use_first[edge_run.begin], rows.use_first[edge_run.end]};
  copy_run(rows.shells, {rows.shell_first[d], rows.shell_first[d + 1]}, out.node_shells, shells);
  copy_run(rows.edge_high, edge_run, out.edge_high, edges);
  copy_shifted(rows.use_first, edge_run, static_cast<std::int64_t>(uses) - static_cast<std::int64_t>(use_run.begin), out.edge_shell_first,
               edges);
  copy_run(rows.edge_shells, use_run, out.edge_shells, uses);
}

template <class T>
void size_for(std::vector<T>& values, std::size_t old_size, std::int64_t shift) {
  const auto size = static_cast<std::size_t>(static_cast<std::int64_t>(old_size) + shift);
  reserve_large(values, size);
  values.resize(size);
}

}  // namespace

Adjacency update_adjacency(const Model& before, const Model& after) {
  const Adjacency& old = *before.adjacency;
  const ShellSet changed = changed_shells(changes_between(before, after));
  std::vector<Incidence> incidences;
  add_corners(after, changed, incidences);
  std::sort(incidences.begin(), incidences.end());
  std::vector<NodeIndex> nodes = dirty_nodes(before, after, changed, incidences);
  if (nodes.size() > after.node_count() / kFewNodes) return build_adjacency(after);
  const DirtyRows rows = dirty_rows(before, after, changed, incidences, std::move(nodes));
  Adjacency out;
  size_for(out.node_first, after.node_count() + 1, 0);
  size_for(out.node_shells, old.node_shells.size(), rows.shell_shift.back());
  size_for(out.edge_first, after.node_count() + 1, 0);
  size_for(out.edge_high, old.edge_high.size(), rows.edge_shift.back());
  size_for(out.edge_shell_first, old.edge_high.size() + 1, rows.edge_shift.back());
  size_for(out.edge_shells, old.edge_shells.size(), rows.use_shift.back());
  parallel_for(after.node_count(), kUpdateGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t d = static_cast<std::size_t>(std::lower_bound(rows.nodes.begin(), rows.nodes.end(), NodeIndex(begin)) - rows.nodes.begin());
    for (std::size_t node = begin; node < end; ++d) {
      const std::size_t stop = d < rows.nodes.size() ? std::min<std::size_t>(rows.nodes[d].value, end) : end;
      copy_clean(old, rows, d, {node, stop}, out);
      node = stop;
      if (node >= end) break;
      put_dirty(old, rows, d, out);
      ++node;
    }
  });
  out.node_first.back() = static_cast<std::uint32_t>(out.node_shells.size());
  out.edge_first.back() = static_cast<std::uint32_t>(out.edge_high.size());
  out.edge_shell_first.back() = static_cast<std::uint32_t>(out.edge_shells.size());
  return out;
}

}  // namespace prismesh::mesh
