#include "mesh/document/motion.h"

#include <algorithm>
#include <vector>

#include "mesh/shape/move.h"
#include "mesh/shape/rotate.h"

namespace prismesh::mesh::document {

std::uint32_t Motion::place_of(NodeIndex node) const {
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
  return at != nodes.end() && *at == node ? static_cast<std::uint32_t>(at - nodes.begin()) : Follower::kStays;
}

namespace {

/// Moves along the surface. The moves of a pair of images are added first; then each goes over the faces of its own side.
std::size_t slide_to(const Motion& motion, const Vec3& displacement, std::span<Vec3> out) {
  std::vector<Vec3> by(motion.nodes.size());
  for (std::size_t i = 0; i < by.size(); ++i) by[i] = motion.weight[i] * (motion.turns[i] * displacement);
  if (motion.plane) by = shape::mirror_moves(*motion.plane, motion.mirrored, by);
  return motion.tracer->positions(by, motion.max_move, out);
}

/// Adds to each node's move the mirrored one of its image.
void mirror(const Motion& motion, std::span<Vec3> out) {
  std::vector<Vec3> moves(out.size());
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = out[i] - motion.start[i];
  moves = shape::mirror_moves(*motion.plane, motion.mirrored, moves);
  for (std::size_t i = 0; i < moves.size(); ++i) out[i] = motion.start[i] + moves[i];
}

void follow(const Motion& motion, std::span<Vec3> out) {
  for (const Motion::Follower& follower : motion.followers) {
    Vec3 move = Vec3::Zero();
    for (std::size_t i = 0; i < follower.of.size(); ++i)
      if (const std::uint32_t of = follower.of[i]; of != Motion::Follower::kStays) move += follower.share[i] * (out[of] - motion.start[of]);
    out[follower.node] = motion.start[follower.node] + move;
  }
}

/// Limits the moves to max_move. Returns how many nodes were beyond it.
std::size_t hold_back(const Motion& motion, std::span<Vec3> out) {
  if (!motion.max_move) return 0;
  std::size_t held_back = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 move = out[i] - motion.start[i];
    const double length = move.norm();
    if (!(length > *motion.max_move)) continue;
    out[i] = motion.start[i] + move * (*motion.max_move / length);
    ++held_back;
  }
  return held_back;
}

}  // namespace

std::size_t positions_at(const Motion& motion, const Displacement& displacement, std::span<Vec3> out) {
  std::size_t held_back = 0;
  switch (motion.kind) {
    case ShapingKind::translate: shape::translate(motion.start, motion.weight, displacement.by, out); break;
    case ShapingKind::lift: shape::lift(motion.start, motion.weight, motion.normals, displacement.distance, out); break;
    case ShapingKind::rotate:
      held_back = shape::rotate(motion.start, motion.weight, {motion.axis, displacement.degrees, motion.max_move}, out);
      break;
    case ShapingKind::move:
      shape::rotate(motion.start, motion.weight, {motion.axis, displacement.degrees, std::nullopt}, out);
      shape::translate(out, motion.weight, displacement.by, out);
      break;
    case ShapingKind::slide: held_back = slide_to(motion, displacement.by, out); break;
  }
  if (motion.plane && motion.kind != ShapingKind::slide) mirror(motion, out);
  follow(motion, out);
  // Rotating and sliding limit a node on its path.
  if (motion.kind != ShapingKind::rotate && motion.kind != ShapingKind::slide) held_back = hold_back(motion, out);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] == motion.start[i]) out[i] = motion.start[i];  // -0 stays -0: a node that hasn't moved keeps its bits
  return held_back;
}

}  // namespace prismesh::mesh::document
