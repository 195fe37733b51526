// Makes the haptic pen's field of a generation: both bricks, the triangles that moved, and the distances without them.
#pragma once

#include <cstdint>

#include "base/haptic_field.h"
#include "mesh/field/brick.h"
#include "mesh/field/placement.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::field {

/// A state of the model: its tree and its number, which is never 0.
struct FieldState {
  const spatial::BoxTree* tree = nullptr;
  std::uint64_t generation = 0;
};

/// Null: none.
struct EarlierField {
  const HapticField* field = nullptr;  ///< whose blocks may be taken over: the newest is best
  FieldState state;                    ///< of the field that the reader acquired last: what has moved is told since this one
  spatial::FloatBox changed;  ///< contains each shell that has changed since `field`, as it was and as it is (BoxTree::Update::changed)
};

/// Fills all of a field but `number`, `time_ns` and `placement`. Of an earlier field of the same placement, the blocks are taken over where
/// no change is near. Precondition: the earlier field isn't `field`.
void fill_field(const FieldState& now, const EarlierField& earlier, const Placement& placement, const Vec3& pen_mm, HapticField& field);

}  // namespace prismesh::mesh::field
