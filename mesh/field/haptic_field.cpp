#include "mesh/field/haptic_field.h"

#include <algorithm>
#include <memory>

#include "mesh/field/moved_triangles.h"

namespace prismesh::mesh::field {

namespace {

std::size_t nodes_of(const HapticBrick& brick) {
  return static_cast<std::size_t>(brick.count[0]) * static_cast<std::size_t>(brick.count[1]) * static_cast<std::size_t>(brick.count[2]);
}

void all_is_still(HapticBrick& brick) { std::copy_n(brick.distance_mm, nodes_of(brick), brick.still_mm); }

/// The distances without the shells that moved differ near these only.
void fill_still(const spatial::BoxTree& now, const ShellSet& moved, const Placement& placement, const Vec3& pen_mm, HapticField& field) {
  spatial::FloatBox changed;
  for (const ShellIndex shell : moved) changed.add(now.box_of(shell));
  spatial::BoxTree still = now;
  still.leave_out(moved);
  const auto fine = std::make_unique_for_overwrite<HapticBrick>(), coarse = std::make_unique_for_overwrite<HapticBrick>();
  fill_bricks(still, placement, pen_mm, *fine, *coarse, {&field.fine, changed}, {&field.coarse, changed});
  std::copy_n(fine->distance_mm, nodes_of(*fine), field.fine.still_mm);
  std::copy_n(coarse->distance_mm, nodes_of(*coarse), field.coarse.still_mm);
}

}  // namespace

void fill_field(const FieldState& now, const EarlierField& earlier, const Placement& placement, const Vec3& pen_mm, HapticField& field) {
  EarlierBrick fine, coarse;
  if (earlier.field != nullptr) {
    fine = {&earlier.field->fine, earlier.changed};
    coarse = {&earlier.field->coarse, earlier.changed};
  }
  fill_bricks(*now.tree, placement, pen_mm, field.fine, field.coarse, fine, coarse);
  field.mesh_generation = now.generation;
  field.unused = 0;
  ShellSet moved;
  if (earlier.field != nullptr)
    moved = fill_moved(*earlier.state.tree, *now.tree, placement, earlier.state.generation, coarse_shape().reach_mm, field);
  else
    fill_unknown_motion(field);
  if (!moved.empty()) return fill_still(*now.tree, moved, placement, pen_mm, field);
  all_is_still(field.fine);
  all_is_still(field.coarse);
}

}  // namespace prismesh::mesh::field
