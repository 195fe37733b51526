#include "mesh/contact/cut_pieces.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "mesh/contact/orientation.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kMaxTimesLarger = 4;  ///< a larger piece is of use up to this multiple of what is cut off

using Link = std::pair<NodeIndex, NodeIndex>;  ///< the lower index first

Link link_of(NodeIndex a, NodeIndex b) { return {std::min(a, b), std::max(a, b)}; }

/// Calls `visit(NodeIndex, NodeIndex)` for the sides of a shell and a quad's diagonal.
template <class Visit>
void each_link(const ShellNodes& nodes, Visit&& visit) {
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i) visit(nodes.node[i], nodes.node[(i + 1) % corners]);
  if (corners == 4) visit(nodes.node[0], nodes.node[2]);
}

/// What the other sheet takes from the net of nodes and links of a sheet.
struct TakenByOther {
  std::vector<NodeIndex> nodes;
  std::vector<Link> links;  ///< both ascending

  bool has(NodeIndex node) const { return std::binary_search(nodes.begin(), nodes.end(), node); }
  bool has(NodeIndex a, NodeIndex b) const { return std::binary_search(links.begin(), links.end(), link_of(a, b)); }
};

TakenByOther find_taken(const Model& model, const Perforation& perforation, bool of_a) {
  TakenByOther taken;
  for (const auto& [a, b] : perforation.crossings) {
    const ShellNodes& own = model.shell(of_a ? a : b);
    each_shell_triangle(model, of_a ? b : a, [&](const ShellTriangle& other) {
      if (on_a_line(other.at[0], other.at[1], other.at[2])) return;
      each_link(own, [&](NodeIndex from, NodeIndex to) {
        const Vec3 &at_from = model.position(from), &at_to = model.position(to);
        if (!can_decide(at_from) || !can_decide(at_to)) return;
        if (passes_through(at_from, at_to, other.at)) taken.links.push_back(link_of(from, to));
        if (lies_in(at_from, other.at)) taken.nodes.push_back(from);
      });
    });
  }
  sort_unique(taken.nodes);
  sort_unique(taken.links);
  return taken;
}

/// Pieces that grow from the nodes at the curve, one node each in turn, and become one where they meet.
class GrowingPieces {
 public:
  GrowingPieces(const Model& model, const TakenByOther& taken) : model_(model), taken_(taken) {}

  void add_seed(NodeIndex node) {
    if (taken_.has(node) || !piece_of_.try_emplace(node.value, nodes_.size()).second) return;
    parent_.push_back(nodes_.size());
    done_.push_back(0);
    nodes_.push_back({node});
  }

  /// Until all pieces but one are complete; that one further while it is small enough to be of use.
  CutPieces grow() {
    while (growing() > 1)
      for (std::size_t piece = 0; piece < nodes_.size(); ++piece)
        if (root(piece) == piece && done_[piece] < nodes_[piece].size()) step(piece);
    std::vector<std::size_t> roots;
    for (std::size_t piece = 0; piece < nodes_.size(); ++piece)
      if (root(piece) == piece) roots.push_back(piece);
    if (roots.size() < 2) return {};
    const auto is_smaller = [&](std::size_t a, std::size_t b) {
      const auto size = [&](std::size_t piece) { return std::pair(done_[piece] < nodes_[piece].size(), nodes_[piece].size()); };
      return size(a) < size(b);
    };
    const std::size_t largest = *std::max_element(roots.begin(), roots.end(), is_smaller);
    CutPieces pieces;
    for (const std::size_t piece : roots)
      if (piece != largest) pieces.cut_off.insert(pieces.cut_off.end(), nodes_[piece].begin(), nodes_[piece].end());
    std::sort(pieces.cut_off.begin(), pieces.cut_off.end());
    const std::size_t max_size = kMaxTimesLarger * pieces.cut_off.size();
    while (done_[largest] < nodes_[largest].size() && nodes_[largest].size() <= max_size) step(largest);
    if (nodes_[largest].size() > max_size) return pieces;
    pieces.larger = std::move(nodes_[largest]);
    std::sort(pieces.larger.begin(), pieces.larger.end());
    return pieces;
  }

 private:
  std::size_t root(std::size_t piece) {
    while (parent_[piece] != piece) piece = parent_[piece] = parent_[parent_[piece]];
    return piece;
  }
  std::size_t growing() {
    std::size_t count = 0;
    for (std::size_t piece = 0; piece < nodes_.size(); ++piece)
      if (root(piece) == piece && done_[piece] < nodes_[piece].size()) ++count;
    return count;
  }
  void step(std::size_t piece) {
    const NodeIndex node = nodes_[piece][done_[piece]++];
    for (const ShellIndex shell : model_.adjacency->shells_of(node))
      each_link(model_.shell(shell), [&](NodeIndex from, NodeIndex to) {
        if (from == to || (from != node && to != node) || taken_.has(from, to)) return;
        reach(root(piece), from == node ? to : from);
      });
  }
  void reach(std::size_t piece, NodeIndex node) {
    if (taken_.has(node)) return;
    const auto [at, is_new] = piece_of_.try_emplace(node.value, piece);
    if (is_new)
      nodes_[piece].push_back(node);
    else if (const std::size_t other = root(at->second); other != piece)
      join(std::min(piece, other), std::max(piece, other));
  }
  /// Both lists: first the nodes that are done, then those that wait.
  void join(std::size_t kept, std::size_t other) {
    std::vector<NodeIndex>&to = nodes_[kept], &from = nodes_[other];
    const auto done = static_cast<std::ptrdiff_t>(done_[other]);
    to.insert(to.begin() + static_cast<std::ptrdiff_t>(done_[kept]), from.begin(), from.begin() + done);
    to.insert(to.end(), from.begin() + done, from.end());
    done_[kept] += done_[other];
    from.clear();
    done_[other] = 0;
    parent_[other] = kept;
  }

  const Model& model_;
  const TakenByOther& taken_;
  std::unordered_map<std::uint32_t, std::size_t> piece_of_;
  std::vector<std::size_t> parent_, done_;
  std::vector<std::vector<NodeIndex>> nodes_;
};

}  // namespace

CutPieces cut_pieces(const Model& model, const Perforation& perforation, bool of_a) {
  const TakenByOther taken = find_taken(model, perforation, of_a);
  GrowingPieces pieces(model, taken);
  for (const ShellIndex shell : of_a ? perforation.shells_a : perforation.shells_b)
    for (const NodeIndex node : model.shell(shell).node) pieces.add_seed(node);
  return pieces.grow();
}

std::vector<NodeIndex> cut_off_nodes(const Model& model, const Perforation& perforation, bool of_a) {
  return cut_pieces(model, perforation, of_a).cut_off;
}

}  // namespace prismesh::mesh::contact
