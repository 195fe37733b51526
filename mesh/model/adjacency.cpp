#include "mesh/model/adjacency.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/large_memory.h"
#include "base/parallel_for.h"
#include "mesh/model/edge_uses.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

namespace {

constexpr std::size_t kNodeGrain = 32768;

/// Counting sort: the shells come in order, so each node's list ascends.
void fill_node_shells(const Model& model, Adjacency& adjacency) {
  // Counts start two places late: after the running sum first[n + 1] is where node n begins, and once it is filled where it
  // ends, which is where node n + 1 begins.
  std::vector<std::uint32_t>& first = adjacency.node_first;
  reserve_large(first, model.node_count() + 2);
  first.assign(model.node_count() + 2, 0);
  const auto each_corner = [&](const auto& body) {
    std::size_t shell = 0;
    for (std::size_t c = 0; c < model.shell_nodes.chunk_count(); ++c)
      for (const ShellNodes& nodes : model.shell_nodes.chunk(c)) {
        const Corners corners = distinct_corners(nodes);
        for (int i = 0; i < corners.count; ++i) body(corners.node[i].value, shell);
        ++shell;
      }
  };
  std::size_t total = 0;
  each_corner([&](std::uint32_t node, std::size_t) {
    ++first[node + 2];
    ++total;
  });
  for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
  reserve_large(adjacency.node_shells, total);
  adjacency.node_shells.resize(total);
  each_corner([&](std::uint32_t node, std::size_t shell) { adjacency.node_shells[first[node + 1]++] = ShellIndex(shell); });
  first.pop_back();
}

/// The part of the edge table whose low ends lie in one range of nodes; positions count from the range's first.
struct EdgePiece {
  std::vector<std::uint32_t> edges_of_node;
  std::vector<NodeIndex> high;
  std::vector<std::uint32_t> shell_first;
  std::vector<ShellIndex> shells;
};

EdgePiece edge_piece(const Model& model, const Adjacency& adjacency, std::size_t begin, std::size_t end) {
  EdgePiece piece;
  piece.edges_of_node.reserve(end - begin);
  piece.high.reserve(2 * (end - begin) + 64);
  piece.shell_first.reserve(2 * (end - begin) + 64);
  piece.shells.reserve(4 * (end - begin) + 64);
  std::vector<EdgeUse> uses;
  for (std::size_t node = begin; node < end; ++node) {
    collect_uses(model, adjacency.shells_of(NodeIndex(node)), NodeIndex(node), uses);
    const std::size_t before = piece.high.size();
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (i == 0 || uses[i].high != uses[i - 1].high) {
        piece.high.push_back(uses[i].high);
        piece.shell_first.push_back(static_cast<std::uint32_t>(piece.shells.size()));
      }
      piece.shells.push_back(uses[i].shell);
    }
    piece.edges_of_node.push_back(static_cast<std::uint32_t>(piece.high.size() - before));
  }
  return piece;
}

void join_pieces(const std::vector<EdgePiece>& pieces, std::size_t node_count, Adjacency& adjacency) {
  std::vector<std::size_t> edge_base(pieces.size() + 1, 0), use_base(pieces.size() + 1, 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    edge_base[p + 1] = edge_base[p] + pieces[p].high.size();
    use_base[p + 1] = use_base[p] + pieces[p].shells.size();
  }
  const auto resize = [](auto& values, std::size_t size) {
    reserve_large(values, size);
    values.resize(size);
  };
  resize(adjacency.edge_first, node_count + 1);
  resize(adjacency.edge_high, edge_base.back());
  resize(adjacency.edge_shell_first, edge_base.back() + 1);
  resize(adjacency.edge_shells, use_base.back());
  parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const EdgePiece& piece = pieces[p];
      std::copy(piece.high.begin(), piece.high.end(), adjacency.edge_high.begin() + static_cast<std::ptrdiff_t>(edge_base[p]));
      std::copy(piece.shells.begin(), piece.shells.end(), adjacency.edge_shells.begin() + static_cast<std::ptrdiff_t>(use_base[p]));
      for (std::size_t e = 0; e < piece.shell_first.size(); ++e)
        adjacency.edge_shell_first[edge_base[p] + e] = static_cast<std::uint32_t>(use_base[p] + piece.shell_first[e]);
      std::size_t first = edge_base[p];
      for (std::size_t n = 0; n < piece.edges_of_node.size(); ++n) {
        adjacency.edge_first[p * kNodeGrain + n] = static_cast<std::uint32_t>(first);
        first += piece.edges_of_node[n];
      }
    }
  });
  adjacency.edge_first.back() = static_cast<std::uint32_t>(edge_base.back());
  adjacency.edge_shell_first.back() = static_cast<std::uint32_t>(use_base.back());
}

}  // namespace

EdgeIndex Adjacency::find_edge(NodeIndex a, NodeIndex b) const {
  const auto [low, high] = std::minmax(a, b);
  const auto begin = edge_high.begin() + edge_first[low.value];
  const auto end = edge_high.begin() + edge_first[low.value + 1];
  const auto found = std::lower_bound(begin, end, high);
  if (found == end || *found != high) return {};
  return EdgeIndex(static_cast<std::size_t>(found - edge_high.begin()));
}

Edge Adjacency::edge(EdgeIndex edge) const {
  const auto after = std::upper_bound(edge_first.begin(), edge_first.end(), edge.value);
  return {NodeIndex(static_cast<std::size_t>(after - edge_first.begin() - 1)), edge_high[edge.value]};
}

Adjacency build_adjacency(const Model& model) {
  Adjacency adjacency;
  fill_node_shells(model, adjacency);
  std::vector<EdgePiece> pieces((model.node_count() + kNodeGrain - 1) / kNodeGrain);
  parallel_for(model.node_count(), kNodeGrain,
               [&](std::size_t begin, std::size_t end) { pieces[begin / kNodeGrain] = edge_piece(model, adjacency, begin, end); });
  join_pieces(pieces, model.node_count(), adjacency);
  return adjacency;
}

std::vector<std::uint8_t> free_edge_nodes(const Adjacency& adjacency, std::size_t node_count) {
  std::vector<std::uint8_t> is_free(node_count, 0);
  for (std::size_t low = 0; low + 1 < adjacency.edge_first.size(); ++low)
    for (std::uint32_t e = adjacency.edge_first[low]; e < adjacency.edge_first[low + 1]; ++e)
      if (adjacency.edge_shell_first[e + 1] - adjacency.edge_shell_first[e] == 1) {
        is_free[low] = 1;
        is_free[adjacency.edge_high[e].value] = 1;
      }
  return is_free;
}

}  // namespace prismesh::mesh
