#include "mesh/field/moved_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

namespace prismesh::mesh::field {

namespace {

using spatial::BoxTree;

constexpr double kMovedReachSpacings = 2;  ///< of the fine brick: base/haptic_field.h
constexpr double kRoundingReach = 1e-4;    ///< the same; more than single precision loses

struct Triangles {
  std::array<std::array<Vec3, 3>, 2> corner;
  std::array<bool, 2> finite{};
};

Triangles triangles_of(const BoxTree& tree, ShellIndex shell) {
  Triangles triangles;
  tree.each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool second) {
    triangles.corner[second ? 1 : 0] = {a, b, c};
    triangles.finite[second ? 1 : 0] = true;
  });
  return triangles;
}

/// The longest way of any node, in the model.
double max_moved(const BoxTree& before, const BoxTree& now) {
  double max2 = 0;
  const ChunkedArray<Vec3>&from = before.positions(), &to = now.positions();
  for (std::size_t c = 0; c < std::min(from.chunk_count(), to.chunk_count()); ++c) {
    if (from.chunk_owner(c) == to.chunk_owner(c)) continue;
    const std::span<const Vec3> a = from.chunk(c), b = to.chunk(c);
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      if (const double way2 = (a[i] - b[i]).squaredNorm(); std::isfinite(way2)) max2 = std::max(max2, way2);
  }
  return std::sqrt(max2);
}

/// A brick in the pen's space, and what contains it in the model.
struct BrickBox {
  Vec3 low_mm, high_mm;
  Vec3 low, high;
};

BrickBox box_of(const HapticBrick& brick, const Placement& placement) {
  BrickBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low_mm[axis] = brick.origin_mm[axis];
    box.high_mm[axis] = brick.origin_mm[axis] + brick.spacing_mm * (brick.count[axis] - 1);
  }
  box.low = box.high = placement.to_model(box.low_mm);
  for (int corner = 1; corner < 8; ++corner) {
    const Vec3 at((corner & 1) != 0 ? box.high_mm.x() : box.low_mm.x(), (corner & 2) != 0 ? box.high_mm.y() : box.low_mm.y(),
                  (corner & 4) != 0 ? box.high_mm.z() : box.low_mm.z());
    box.low = box.low.cwiseMin(placement.to_model(at));
    box.high = box.high.cwiseMax(placement.to_model(at));
  }
  return box;
}

/// Shells of a tree near the brick, ascending.
ShellSet shells_near(const BoxTree& tree, const BrickBox& box, double distance, std::size_t max) {
  ShellSet shells;
  tree.near_box(box.low, box.high, distance, [&](ShellIndex shell, const spatial::FloatBox&) {
    shells.push_back(shell);
    return shells.size() <= max;
  });
  std::sort(shells.begin(), shells.end());
  return shells;
}

/// Whether the shells with other corners, added or removed ones among them, are all far from the brick in both states.
bool corners_stay(const BoxTree& before, const BoxTree& now, const ShellSet& near_before, const ShellSet& near_now) {
  const auto same = [&](ShellIndex shell) {
    return before.contains(shell) && now.contains(shell) && before.corners(shell) == now.corners(shell);
  };
  return std::all_of(near_before.begin(), near_before.end(), same) && std::all_of(near_now.begin(), near_now.end(), same);
}

/// Where a triangle is during its motion, grown by the reach: in a box, and between two planes parallel to its last place.
struct MotionBox {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
  Vec3 normal = Vec3::Zero();
  double low_plane = 0, high_plane = 0;
};

using Corners = std::array<Vec3, 3>;

MotionBox motion_box(const Corners& from, const Corners& to, double reach_mm) {
  MotionBox motion;
  const Vec3 area = (to[1] - to[0]).cross(to[2] - to[0]);
  if (area.norm() > 0) motion.normal = area.normalized();
  motion.low_plane = HUGE_VAL;
  motion.high_plane = -HUGE_VAL;
  for (const Corners& corners : {from, to})
    for (const Vec3& corner : corners) {
      motion.low = motion.low.cwiseMin(corner);
      motion.high = motion.high.cwiseMax(corner);
      motion.low_plane = std::min(motion.low_plane, motion.normal.dot(corner));
      motion.high_plane = std::max(motion.high_plane, motion.normal.dot(corner));
    }
  motion.low.array() -= reach_mm;
  motion.high.array() += reach_mm;
  motion.low_plane -= reach_mm;
  motion.high_plane += reach_mm;
  return motion;
}

MovedTriangle moved_triangle(const Corners& from, const Corners& to, ShellIndex shell) {
  MovedTriangle moved{};
  double radius = 0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    radius = std::max({radius, (from[corner] - from[0]).norm(), (to[corner] - to[0]).norm()});
    for (int axis = 0; axis < 3; ++axis) {
      moved.before_mm[corner][axis] = static_cast<float>(from[corner][axis]);
      moved.now_mm[corner][axis] = static_cast<float>(to[corner][axis]);
    }
  }
  moved.radius_mm = spatial::rounded_up(radius + kRoundingReach);
  moved.element = static_cast<std::int32_t>(shell.value);
  return moved;
}

/// Adds a moved triangle, in the pen's space, if its motion comes near the brick. Returns false if there is no room.
bool add_moved(const Corners& from, const Corners& to, ShellIndex shell, const BrickBox& box, HapticField& field,
               std::vector<MotionBox>& motions) {
  const MotionBox motion = motion_box(from, to, field.moved_reach_mm + kRoundingReach);
  if ((motion.low.array() > box.high_mm.array()).any() || (motion.high.array() < box.low_mm.array()).any()) return true;
  if (field.moved_count == kMaxMovedTriangles) return false;
  field.moved[field.moved_count++] = moved_triangle(from, to, shell);
  motions.push_back(motion);
  return true;
}

/// Calls `visit(bucket)` for each bucket that a motion may meet.
template <class Visit>
void each_bucket(const MotionBox& motion, const BrickBox& box, Visit&& visit) {
  const Vec3 size = (box.high_mm - box.low_mm) / kBucketSide;
  std::array<int, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto bucket = [&](double at) {
      return static_cast<int>(std::clamp(std::floor((at - box.low_mm[axis]) / size[axis]), 0.0, kBucketSide - 1.0));
    };
    first[static_cast<std::size_t>(axis)] = bucket(motion.low[axis]);
    last[static_cast<std::size_t>(axis)] = bucket(motion.high[axis]);
  }
  const double half = 0.5 * size.dot(motion.normal.cwiseAbs());
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) {
        const double middle = motion.normal.dot(box.low_mm + size.cwiseProduct(Vec3(x + 0.5, y + 0.5, z + 0.5)));
        if (middle + half < motion.low_plane || middle - half > motion.high_plane) continue;
        visit(static_cast<std::size_t>(x + kBucketSide * (y + kBucketSide * z)));
      }
}

/// Returns false if there is no room.
bool fill_buckets(const std::vector<MotionBox>& motions, const BrickBox& box, HapticField& field) {
  std::vector<std::uint32_t> count(kBuckets + 1, 0);
  std::uint64_t entries = 0;
  for (const MotionBox& motion : motions)
    each_bucket(motion, box, [&](std::size_t bucket) {
      ++count[bucket + 1];
      ++entries;
    });
  if (entries > kMaxBucketEntries) return false;
  for (std::size_t b = 0; b < kBuckets; ++b) count[b + 1] += count[b];
  std::copy(count.begin(), count.end(), field.bucket_begin);
  for (std::size_t i = 0; i < motions.size(); ++i)
    each_bucket(motions[i], box, [&](std::size_t bucket) { field.bucket_entry[count[bucket]++] = static_cast<std::uint16_t>(i); });
  return true;
}

}  // namespace

void fill_unknown_motion(HapticField& field) {
  field.before_generation = 0;
  field.max_moved_mm = 0;
  field.moved_reach_mm = kMovedReachSpacings * field.fine.spacing_mm;
  field.moved_count = 0;
  std::fill(std::begin(field.bucket_begin), std::end(field.bucket_begin), 0U);
}

ShellSet fill_moved(const BoxTree& before, const BoxTree& now, const Placement& placement, std::uint64_t before_generation, double near_mm,
                    HapticField& field) {
  fill_unknown_motion(field);
  const double way = max_moved(before, now);
  const BrickBox box = box_of(field.coarse, placement), fine = box_of(field.fine, placement);
  // what passes the brick is no farther than its way from it in either state
  const double near = (std::max(field.moved_reach_mm, near_mm) + kRoundingReach) / placement.scale + way;
  const std::size_t max_shells = std::size_t{16} * kMaxMovedTriangles;
  const ShellSet near_now = shells_near(now, box, near, max_shells), near_before = shells_near(before, box, near, max_shells);
  if (near_now.size() > max_shells || near_before.size() > max_shells || !corners_stay(before, now, near_before, near_now)) return {};
  ShellSet shells;
  std::vector<MotionBox> motions;
  double max_way_mm = 0;
  bool fits = true;
  for (const ShellIndex shell : near_now) {
    const Triangles from = triangles_of(before, shell), to = triangles_of(now, shell);
    bool moved = false;
    fits = fits && from.finite == to.finite;
    for (std::size_t t = 0; t < 2 && fits; ++t) {
      if (!to.finite[t] || from.corner[t] == to.corner[t]) continue;
      moved = true;
      Corners before_mm, now_mm;
      for (std::size_t c = 0; c < 3; ++c) {
        before_mm[c] = placement.to_pen(from.corner[t][c]);
        now_mm[c] = placement.to_pen(to.corner[t][c]);
        max_way_mm = std::max(max_way_mm, (now_mm[c] - before_mm[c]).norm());
      }
      fits = add_moved(before_mm, now_mm, shell, fine, field, motions);
    }
    if (moved) shells.push_back(shell);
  }
  if (!fits || !fill_buckets(motions, fine, field)) {
    fill_unknown_motion(field);
    return {};
  }
  field.max_moved_mm = max_way_mm;
  field.before_generation = before_generation;
  return shells;
}

}  // namespace prismesh::mesh::field
