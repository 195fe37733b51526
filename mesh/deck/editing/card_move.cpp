#include "mesh/deck/editing/card_move.h"

#include <algorithm>
#include <cmath>

namespace prismesh::mesh::deck {
namespace {

/// Coordinates of a card in a frame of its own that differ by no more than this share of the node's distance from the frame's origin
/// are the same: the way there and back costs the last digits.
constexpr double kSameInFrame = 1e-13;

}  // namespace

std::optional<CardMove> in_card(const Deck& deck, const CardWriter& writer, const CardRun& run, std::size_t offset, const Vec3& from,
                                const Vec3& to) {
  const Frame& frame = deck.frames[run.frame];
  if (frame.is_basic()) return CardMove{from, to};
  const std::optional<Vec3> before = writer.node_coordinates({deck.files[run.file].bytes.text(), offset, run.style});
  std::optional<Vec3> after;
  if (before) after = to_card(frame, to, *before);
  if (!after || !after->allFinite()) return std::nullopt;
  const double same = kSameInFrame * std::max(before->cwiseAbs().maxCoeff(), after->cwiseAbs().maxCoeff());
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs((*after)[axis] - (*before)[axis]) <= same) (*after)[axis] = (*before)[axis];
  return CardMove{*before, *after};
}

}  // namespace prismesh::mesh::deck
