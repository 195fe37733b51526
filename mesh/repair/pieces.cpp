#include "mesh/repair/pieces.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "mesh/repair/change_history.h"
#include "mesh/repair/local_size.h"
#include "mesh/repair/strips.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kRingsOfStrip = 4;     ///< about a strip, and twice as many about a shell to repair
constexpr double kNearlyLong = 1.1;  ///< target sizes: a strip that is as wide may be divided, if not now, then after relaxing
constexpr double kNearlyShort = 0.7;
constexpr long kMinShare = 2;  ///< triangles that each piece may make, if all may

using Marks = std::vector<std::uint8_t>;  ///< by shell of the patch

/// Marks the shells that have a node in common with a marked one.
void add_ring(const Patch& patch, Marks& marked) {
  std::vector<std::uint8_t> node_marked(patch.node_count(), 0);
  for (std::size_t s = 0; s < marked.size(); ++s)
    if (marked[s] != 0)
      for (const LocalNode corner : patch.shell(LocalShell(s)).corners) node_marked[corner.value] = 1;
  for (std::size_t n = 0; n < node_marked.size(); ++n)
    if (node_marked[n] != 0)
      for (const LocalShell shell : patch.node(LocalNode(n)).shells) marked[shell.value] = 1;
}

/// Marks the strips of quads that a repair might divide or remove for the sake of bad shells.
class StripMarker {
 public:
  StripMarker(const RepairContext& context, Marks& marked) : context_(context), marked_(marked) {}

  void mark_at(LocalShell shell) {
    const Corners& corners = context_.patch.shell(shell).corners;
    if (corner_count(corners) != 4) return;
    const double size = target_size_of(context_, shell);
    for (int edge = 0; edge < 2; ++edge) {
      const double width = 0.5 * (length(corners, edge) + length(corners, edge + 2));
      if ((width > kNearlyShort * size && width < kNearlyLong * size) || known_.contains({shell, edge})) continue;
      mark({shell, edge});
      // A strip that crosses itself is possible only where its edges' lengths end it.
      if (known_.contains({shell, edge})) continue;
      mark({shell, edge, 0, kNearlyShort * size});
      mark({shell, edge, size, std::numeric_limits<double>::infinity()});
    }
  }

 private:
  double length(const Corners& corners, int edge) const {
    const Patch& patch = context_.patch;
    const auto e = static_cast<std::size_t>(edge);
    return (patch.position(corners[e]) - patch.position(corners[(e + 1) % 4])).norm();
  }
  void mark(const Strip& strip) {
    for (const StripQuad& quad : path_of(context_.patch, strip).quads) {
      marked_[quad.shell.value] = 1;
      known_.emplace(quad.shell, quad.edge);
    }
  }

  const RepairContext& context_;
  Marks& marked_;
  std::set<std::pair<LocalShell, int>> known_;
};

/// The shells that have to be repaired or are about a node that has to be.
struct Needs {
  std::vector<LocalShell> bad;
  std::vector<LocalNode> crowded;
};

Marks reach_of(const RepairContext& whole, const Needs& needs) {
  const Patch& patch = whole.patch;
  Marks marked(patch.shell_count(), 0);
  for (const LocalShell shell : needs.bad) marked[shell.value] = 1;
  for (const LocalNode node : needs.crowded)
    for (const LocalShell shell : patch.node(node).shells) marked[shell.value] = 1;
  for (int ring = 0; ring < kRingsOfStrip; ++ring) add_ring(patch, marked);
  StripMarker strips(whole, marked);
  for (const LocalShell shell : needs.bad) strips.mark_at(shell);
  for (int ring = 0; ring < kRingsOfStrip; ++ring) add_ring(patch, marked);
  return marked;
}

/// The number of the piece of each marked shell, from 0 in the order of the pieces' first shells; -1: none.
std::vector<long> number_pieces(const Patch& patch, const Marks& marked) {
  std::vector<long> piece(marked.size(), -1);
  long count = 0;
  for (std::size_t first = 0; first < marked.size(); ++first) {
    if (marked[first] == 0 || piece[first] >= 0) continue;
    std::vector<LocalShell> front{LocalShell(first)};
    piece[first] = count;
    while (!front.empty()) {
      const LocalShell shell = front.back();
      front.pop_back();
      for (const LocalNode corner : patch.shell(shell).corners)
        for (const LocalShell other : patch.node(corner).shells) {
          if (marked[other.value] == 0 || piece[other.value] >= 0) continue;
          piece[other.value] = count;
          front.push_back(other);
        }
    }
    ++count;
  }
  return piece;
}

}  // namespace

std::vector<Piece> pieces_of(const RepairContext& whole, const ChangeHistory& history, const NodeSet& clusters) {
  const Patch& patch = whole.patch;
  Needs needs{bad_shells(patch, history, quality::Grade::warn), {}};
  for (const NodeIndex node : clusters)
    if (const LocalNode local = patch.find(node); local.valid()) needs.crowded.push_back(local);
  const std::vector<long> number = number_pieces(patch, reach_of(whole, needs));
  std::vector<Piece> pieces(number.empty() ? 0 : static_cast<std::size_t>(*std::max_element(number.begin(), number.end()) + 1));
  for (std::size_t s = 0; s < number.size(); ++s)
    if (number[s] >= 0) pieces[static_cast<std::size_t>(number[s])].shells.push_back(patch.shell(LocalShell(s)).model);
  for (const LocalShell shell : needs.bad) ++pieces[static_cast<std::size_t>(number[shell.value])].bad;
  for (Piece& piece : pieces) piece.work = piece.bad;
  for (const LocalNode node : needs.crowded)
    if (!patch.node(node).shells.empty()) ++pieces[static_cast<std::size_t>(number[patch.node(node).shells.front().value])].work;
  return pieces;
}

std::vector<long> shares_of(const std::vector<Piece>& pieces, long allowed) {
  std::vector<long> shares;
  if (pieces.empty()) return shares;
  const auto count = static_cast<long>(pieces.size());
  const long each = std::min(kMinShare, allowed / count), rest = allowed - each * count;
  long all = 0, before = 0;
  for (const Piece& piece : pieces) all += static_cast<long>(piece.work);
  for (const Piece& piece : pieces) {
    // Differences of rounded sums: they add up to the rest, whatever is rounded.
    const long after = before + static_cast<long>(piece.work);
    shares.push_back(each + (all > 0 ? rest * after / all - rest * before / all : 0));
    before = after;
  }
  return shares;
}

}  // namespace prismesh::mesh::repair
