// What the haptic pen feels, as plain data: distances to the shells near the pen, shells that moved, guides, resistance.
//
// modeld fills it from the mesh, deviced reads it in its real-time tick. It stands in base because mesh and drivers never include each
// other. Standard library only; trivially copyable; no pointers, so that it may lie in shared memory.
//
// Space. All coordinates and lengths are millimetres in the pen's own space (the hand's millimetres: x to the right, y up, z toward the
// user). The writer maps nodes of the model into it by one turn, one shift and one scale that is the same in all directions, then computes.
// `placement` numbers this map. A reader whose map has another number treats the field as missing.
//
// Time. CLOCK_MONOTONIC nanoseconds. Each slot has an age of its own: what is older than 100 ms fades (drivers/haptics/limits.h).
//
// Shells. A triangle is itself. A quad of corners 0 1 2 3 is the two triangles 0 1 2 and 0 2 3. Distances and moved triangles use the same
// triangles. Shells that the user can't feel (hidden ones, perhaps) are left out of both.
#pragma once

#include <cstdint>
#include <type_traits>

namespace prismesh {

inline constexpr std::int32_t kMaxBrickSide = 64;
inline constexpr std::int32_t kMaxBrickNodes = kMaxBrickSide * kMaxBrickSide * kMaxBrickSide;
inline constexpr std::int32_t kBucketSide = 16;
inline constexpr std::int32_t kBuckets = kBucketSide * kBucketSide * kBucketSide;
inline constexpr std::int32_t kMaxMovedTriangles = 8192;
inline constexpr std::int32_t kMaxBucketEntries = 65536;
inline constexpr std::int32_t kMaxGuides = 64;

/// A regular grid of distances. Node (x, y, z) lies at origin + spacing * (x, y, z) and has the index x + count[0] * (y + count[1] * z).
/// Between nodes the distance is trilinear. The brick holds for the closed box from its first node to its last.
struct HapticBrick {
  double origin_mm[3];
  double spacing_mm;      ///< the same in all directions; 0.01 to 10
  std::int32_t count[3];  ///< nodes in each direction, 2 to kMaxBrickSide; a count of 0: there is no brick
  std::int32_t unused;
  /// The exact, unsigned distance from the node to the nearest point of any shell, in the places of `mesh_generation`. Its error must stay
  /// below 0.0001 mm. Distances above 4 * spacing may be replaced by any number from 4 * spacing to the true distance, as long as two
  /// neighbouring nodes differ by no more than their distance (a minimum with a constant does that). Without shells: any such constant.
  float distance_mm[kMaxBrickNodes];
  /// The same for the shells of which no corner has moved since `before_generation`. Read only where max_moved_mm > 0 and before_generation
  /// isn't 0; so distance_mm is the smaller of this and the distance to the moved triangles in their new places.
  float still_mm[kMaxBrickNodes];
  std::int32_t nearest[kMaxBrickNodes];  ///< the mesh's index of the element that has this nearest point; -1: none, or not known
};

/// A triangle that lies elsewhere than in `before_generation`. Between the two places each corner moves on a straight line, all at once.
struct MovedTriangle {
  float before_mm[3][3];  ///< corner, then x y z
  float now_mm[3][3];     ///< the same corners in `mesh_generation`
  float
      radius_mm;  ///< no point of the triangle is farther from its first corner, at any time: the longer of the edges at it, in both places
  std::int32_t element;  ///< the mesh's index
};

/// The shells near the pen. The fine brick covers the pen's position ± 10 mm, the coarse one where the pen can be 20 ms later (± 40 mm at
/// 1.5 m/s). The fine brick lies in the coarse one. Outside of both, space counts as free: the reader lets go, the force is zero, and
/// contact begins again only where the pen is clear of shells inside a brick.
struct HapticField {
  std::uint64_t number;             ///< counts the fields that were published; 0: none yet
  std::int64_t time_ns;             ///< when the places of the shells were read
  std::uint64_t placement;          ///< number of the map from the model to the pen's space
  std::uint64_t mesh_generation;    ///< changes when a shell in the coarse brick moves, appears or disappears; never 0
  std::uint64_t before_generation;  ///< the generation of `before_mm`; 0: unknown, or shells have appeared or disappeared
  HapticBrick fine, coarse;

  double max_moved_mm;  ///< the longest way of any corner since before_generation, over all shells of the coarse brick; 0: none moved
  /// Every triangle that moved since `before_generation` and at any time of its motion comes within `moved_reach_mm` of the fine brick. The
  /// reader uses them only if it has last read a field of `before_generation`; otherwise it lets go. So the writer should take for
  /// `before_generation` the one that the reader has acquired last.
  double moved_reach_mm;     ///< at least 2 * fine.spacing_mm; more makes buckets fuller
  std::int32_t moved_count;  ///< at most kMaxMovedTriangles; if there are more, set before_generation = 0
  std::int32_t unused;
  MovedTriangle moved[kMaxMovedTriangles];
  /// The fine brick's box in 16 equal parts in each direction; bucket (x, y, z) has the index x + 16 * (y + 16 * z). Its entries are
  /// bucket_entry[bucket_begin[i]] to before bucket_begin[i + 1]: indices into `moved` of all triangles that at any time of their motion
  /// come within `moved_reach_mm` of the bucket's box. More are allowed: the box about both places, grown by the reach, is the usual test.
  std::uint32_t bucket_begin[kBuckets + 1];
  std::uint16_t bucket_entry[kMaxBucketEntries];
};

/// A node (both ends equal) or a piece of a feature line to which the pen is pulled gently.
struct HapticGuide {
  double from_mm[3];
  double to_mm[3];
};

struct HapticGuides {
  std::uint64_t placement;
  std::int64_t time_ns;
  std::int32_t count;  ///< at most kMaxGuides
  std::int32_t unused;
  HapticGuide guides[kMaxGuides];
};

/// What resists while a patch is dragged and its elements get worse.
struct HapticResistance {
  std::uint64_t placement;
  std::int64_t time_ns;
  double newton;        ///< 0 and more; grows as the worst element of the patch gets worse
  double direction[3];  ///< unit vector in the pen's space: moving this way makes the elements worse
};

static_assert(std::is_trivially_copyable_v<HapticField> && std::is_standard_layout_v<HapticField>);
static_assert(std::is_trivially_copyable_v<HapticGuides> && std::is_trivially_copyable_v<HapticResistance>);

}  // namespace prismesh
