#include "mesh/deck/editing/card_move.h"

#include <algorithm>
#include <cmath>

namespace prismesh::mesh::deck {
namespace {

/// Coordinates in a frame that differ by no more than this share of the largest coordinate are equal: converting there and back costs the
/// last digits.
constexpr double kSameInFrame = 1e-13;

}  // namespace

std::optional<NodeMove> move_in_card(const Deck& deck, const CardWriter& writer, const CardRun& run, std::size_t offset,
                                     const NodeMove& move) {
  const Frame& frame = deck.frames[run.frame];
  if (frame.is_basic()) return move;
  const std::optional<Vec3> before = writer.node_coordinates({deck.files[run.file].bytes.text(), offset, run.style});
  std::optional<Vec3> after;
  if (before) after = to_card(frame, move.to, *before);
  if (!after || !after->allFinite()) return std::nullopt;
  const double same = kSameInFrame * std::max(before->cwiseAbs().maxCoeff(), after->cwiseAbs().maxCoeff());
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs((*after)[axis] - (*before)[axis]) <= same) (*after)[axis] = (*before)[axis];
  return NodeMove{*before, *after};
}

}  // namespace prismesh::mesh::deck
