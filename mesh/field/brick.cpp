#include "mesh/field/brick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/field/triangle_frame.h"

namespace prismesh::mesh::field {

namespace {

using spatial::BoxTree;

constexpr std::size_t kMaxListed = 160;  ///< shells of a block's list; where more are near, each node asks the tree
constexpr int kTasksOfBrick = 8;

/// The nodes from `first` on, `side` in each direction, a power of 2; those beyond the brick's count don't exist.
struct Block {
  std::array<int, 3> first;
  int side;
};

Block part_of(const Block& block, int part) {
  const int half = block.side / 2;
  return {{block.first[0] + half * (part & 1), block.first[1] + half * (part >> 1 & 1), block.first[2] + half * (part >> 2)}, half};
}

/// Fills blocks of one brick. Each block's distances are computed from the block's first node, so that they don't depend on the brick.
class BrickFiller {
 public:
  BrickFiller(const BoxTree& tree, const Placement& placement, const BrickShape& shape, HapticBrick& brick, const EarlierBrick& earlier)
      : tree_(tree),
        placement_(placement),
        brick_(brick),
        earlier_(earlier),
        count_(shape.count),
        spacing_(shape.spacing_mm),
        reach_(shape.reach_mm),
        margin_(1e-5 * (reach_ + spacing_)) {
    for (int axis = 0; axis < 3; ++axis) {
      first_[axis] = node_number(brick.origin_mm[axis]);
      if (earlier.brick != nullptr)
        shift_[static_cast<std::size_t>(axis)] = static_cast<int>(first_[axis] - node_number(earlier.brick->origin_mm[axis]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      changed_low_[static_cast<Eigen::Index>(axis)] = earlier.changed.low[axis];
      changed_high_[static_cast<Eigen::Index>(axis)] = earlier.changed.high[axis];
    }
  }

  void fill(const Block& block, ShellIndex hint = {});

 private:
  double node_number(double origin_mm) const { return std::round(origin_mm / spacing_); }
  bool exists(const Block& block) const { return std::max({block.first[0], block.first[1], block.first[2]}) < count_; }
  Vec3 place_of(const std::array<int, 3>& node) const { return spacing_ * (first_ + Vec3(node[0], node[1], node[2])); }
  Vec3 middle_of(const Block& block) const { return place_of(block.first) + Vec3::Constant(0.5 * (block.side - 1) * spacing_); }
  /// From its middle to its farthest node.
  double radius_of(const Block& block) const { return 0.5 * (block.side - 1) * std::sqrt(3.0) * spacing_; }
  std::optional<spatial::SurfacePoint> ask(const Vec3& pen_mm, double max_mm, ShellIndex hint) const {
    return tree_.closest(placement_.to_model(pen_mm), max_mm / placement_.scale, hint);
  }
  std::size_t index_of(const std::array<int, 3>& node) const {
    return static_cast<std::size_t>(node[0] + count_ * (node[1] + count_ * node[2]));
  }
  bool has(const std::array<int, 3>& node) const { return node[0] < count_ && node[1] < count_ && node[2] < count_; }
  void put(const std::array<int, 3>& node, double distance, std::uint32_t element);
  bool take_over(const Block& block);
  void fill_far(const Block& block);
  void ask_each_node(const Block& block, ShellIndex hint);
  bool list_shells(const Block& block, double distance);
  void fill_from_list(const Block& block);
  void fill_eight(const Block& block, const std::vector<LocalTriangle>& list);
  EightPoints middles_of_parts(const Block& block) const;
  void list_frames(ShellIndex shell);

  const BoxTree& tree_;
  const Placement& placement_;
  HapticBrick& brick_;
  const EarlierBrick& earlier_;
  const int count_;
  const double spacing_, reach_, margin_;
  Vec3 first_;                  ///< the brick's first node on the lattice: whole numbers
  std::array<int, 3> shift_{};  ///< added to a node's number in this brick: its number in the earlier one
  Vec3 changed_low_, changed_high_;

  struct Frames {
    std::uint32_t first = 0, count = 0;
  };
  std::unordered_map<std::uint32_t, Frames> frames_of_;  ///< by shell
  std::vector<TriangleFrame> frames_;
  std::vector<ShellIndex> shells_;
  std::vector<LocalTriangle> list_, list_of_part_;
  Vec3 list_from_ = Vec3::Zero();
  std::vector<Float8> from_middles_;
};

void BrickFiller::put(const std::array<int, 3>& node, double distance, std::uint32_t element) {
  if (!has(node)) return;
  const bool near = distance <= reach_;
  brick_.distance_mm[index_of(node)] = static_cast<float>(near ? distance : reach_);
  brick_.nearest[index_of(node)] = near ? static_cast<std::int32_t>(element) : -1;
}

template <class Visit>
void each_node(const Block& block, Visit&& visit) {
  for (int z = 0; z < block.side; ++z)
    for (int y = 0; y < block.side; ++y)
      for (int x = 0; x < block.side; ++x) visit(std::array<int, 3>{block.first[0] + x, block.first[1] + y, block.first[2] + z});
}

void BrickFiller::fill_far(const Block& block) {
  each_node(block, [&](const std::array<int, 3>& node) { put(node, spatial::kInfiniteFloat, 0); });
}

/// Copies a block that the earlier brick has, if what changed is farther than its reach.
bool BrickFiller::take_over(const Block& block) {
  if (earlier_.brick == nullptr) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int first = block.first[axis] + shift_[axis], end = std::min(block.first[axis] + block.side, count_) + shift_[axis];
    if (first < 0 || end > count_) return false;
  }
  if (!earlier_.changed.empty()) {
    const Vec3 middle = placement_.to_model(middle_of(block));
    const double away = (changed_low_ - middle).cwiseMax(middle - changed_high_).cwiseMax(Vec3::Zero()).norm() * placement_.scale;
    if (!(away > reach_ + radius_of(block) + 2 * margin_)) return false;
  }
  each_node(block, [&](const std::array<int, 3>& node) {
    if (!has(node)) return;
    const std::size_t from = index_of({node[0] + shift_[0], node[1] + shift_[1], node[2] + shift_[2]});
    brick_.distance_mm[index_of(node)] = earlier_.brick->distance_mm[from];
    brick_.nearest[index_of(node)] = earlier_.brick->nearest[from];
  });
  return true;
}

/// A block without a shell within reach is done; a large one is divided; a small one takes its distances from the shells near it.
void BrickFiller::fill(const Block& block, ShellIndex hint) {
  if (!exists(block) || take_over(block)) return;
  const double radius = radius_of(block);
  const auto nearest = ask(middle_of(block), reach_ + radius + margin_, hint);
  if (!nearest) return fill_far(block);
  if (block.side <= kBlockSide) {
    if (list_shells(block, nearest->distance * placement_.scale)) return fill_from_list(block);
    if (block.side == 2) return ask_each_node(block, nearest->shell);
  }
  for (int part = 0; part < 8; ++part) fill(part_of(block, part), nearest->shell);
}

/// The nearest shell of a neighbouring node bounds the search.
void BrickFiller::ask_each_node(const Block& block, ShellIndex hint) {
  each_node(block, [&](const std::array<int, 3>& node) {
    if (!has(node)) return;
    const auto nearest = ask(place_of(node), reach_, hint);
    if (!nearest) return put(node, spatial::kInfiniteFloat, 0);
    hint = nearest->shell;
    put(node, nearest->distance * placement_.scale, hint.value);
  });
}

/// Every node's nearest shell is at most twice the radius farther from the middle than the nearest one there. Returns false if too many
/// shells are.
bool BrickFiller::list_shells(const Block& block, double distance) {
  const double radius = radius_of(block);
  const double max_distance = std::min(distance + 2 * radius, reach_ + radius) + margin_;
  const Vec3 middle = placement_.to_model(middle_of(block));
  shells_.clear();
  tree_.near_box(middle, middle, max_distance / placement_.scale, [&](ShellIndex shell, const spatial::FloatBox&) {
    shells_.push_back(shell);
    return shells_.size() <= kMaxListed;
  });
  if (shells_.size() > kMaxListed) return false;
  std::sort(shells_.begin(), shells_.end());
  list_.clear();
  list_from_ = place_of(block.first);
  for (const ShellIndex shell : shells_) list_frames(shell);
  return true;
}

void BrickFiller::list_frames(ShellIndex shell) {
  const auto entry = frames_of_.try_emplace(shell.value);
  Frames& frames = entry.first->second;
  if (entry.second) {
    frames.first = static_cast<std::uint32_t>(frames_.size());
    tree_.each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool) {
      frames_.emplace_back(std::array<Vec3, 3>{placement_.to_pen(a), placement_.to_pen(b), placement_.to_pen(c)}, shell.value);
      ++frames.count;
    });
  }
  for (std::uint32_t i = 0; i < frames.count; ++i) list_.emplace_back(frames_[frames.first + i], list_from_);
}

EightPoints BrickFiller::middles_of_parts(const Block& block) const {
  EightPoints points;
  for (int part = 0; part < 8; ++part) {
    const Vec3 middle = middle_of(part_of(block, part)) - list_from_;
    points.x.set(static_cast<std::size_t>(part), static_cast<float>(middle.x()));
    points.y.set(static_cast<std::size_t>(part), static_cast<float>(middle.y()));
    points.z.set(static_cast<std::size_t>(part), static_cast<float>(middle.z()));
  }
  return points;
}

/// Each of the eight parts takes those of the list that may be nearest to one of its nodes.
void BrickFiller::fill_from_list(const Block& block) {
  if (block.side == 2) return fill_eight(block, list_);
  const EightPoints middles = middles_of_parts(block);
  from_middles_.clear();
  Float8 nearest;
  for (Float4& half : nearest.half) half = Float4{} + spatial::kInfiniteFloat;
  for (const LocalTriangle& triangle : list_) {
    const Float8& distances = from_middles_.emplace_back(distances2(triangle, middles));
    for (int h = 0; h < 2; ++h) nearest.half[h] = distances.half[h] < nearest.half[h] ? distances.half[h] : nearest.half[h];
  }
  for (int part = 0; part < 8; ++part) {
    const Block eight = part_of(block, part);
    if (!exists(eight)) continue;
    const auto lane = static_cast<std::size_t>(part);
    const double radius = radius_of(eight), distance = std::sqrt(nearest[lane]);
    if (distance > reach_ + radius + margin_) {
      fill_far(eight);
      continue;
    }
    const double within = std::min(distance + 2 * radius, reach_ + radius) + margin_;
    const auto within2 = static_cast<float>(within * within);
    list_of_part_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i)
      if (from_middles_[i][lane] <= within2) list_of_part_.push_back(list_[i]);
    fill_eight(eight, list_of_part_);
  }
}

/// The nodes of a block of two a side.
void BrickFiller::fill_eight(const Block& block, const std::vector<LocalTriangle>& list) {
  using Int4 = std::int32_t __attribute__((vector_size(16)));
  const EightPoints nodes = middles_of_parts(block);
  Float4 nearest[2] = {Float4{} + spatial::kInfiniteFloat, Float4{} + spatial::kInfiniteFloat};
  Int4 element[2] = {Int4{}, Int4{}};
  for (const LocalTriangle& triangle : list) {
    const Float8 distances = distances2(triangle, nodes);
    for (int h = 0; h < 2; ++h) {
      const Int4 nearer = distances.half[h] < nearest[h];
      nearest[h] = nearer ? distances.half[h] : nearest[h];
      element[h] = nearer ? Int4{} + static_cast<std::int32_t>(triangle.element) : element[h];
    }
  }
  for (int part = 0; part < 8; ++part)
    put(part_of(block, part).first, std::sqrt(nearest[part / 4][part % 4]), static_cast<std::uint32_t>(element[part / 4][part % 4]));
}

/// Sets where the brick lies: about the pen, from every fourth node of the lattice on.
void place_brick(const BrickShape& shape, const Vec3& pen_mm, HapticBrick& brick) {
  const double block_mm = kBlockSide * shape.spacing_mm;
  brick.spacing_mm = shape.spacing_mm;
  brick.unused = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double first_block = std::round(pen_mm[axis] / block_mm - 0.5 * shape.count / kBlockSide + 0.5 / kBlockSide);
    brick.origin_mm[axis] = shape.spacing_mm * (kBlockSide * first_block);
    brick.count[axis] = shape.count;
  }
}

void fill_part(const BoxTree& tree, const Placement& placement, const BrickShape& shape, HapticBrick& brick, const EarlierBrick& earlier,
               std::size_t part) {
  int side = kBlockSide;
  while (side < shape.count) side *= 2;
  BrickFiller(tree, placement, shape, brick, earlier).fill(part_of({{0, 0, 0}, side}, static_cast<int>(part)));
}

}  // namespace

void fill_brick(const BoxTree& tree, const Placement& placement, const BrickShape& shape, const Vec3& pen_mm, HapticBrick& brick,
                const EarlierBrick& earlier) {
  place_brick(shape, pen_mm, brick);
  parallel_for(kTasksOfBrick, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) fill_part(tree, placement, shape, brick, earlier, part);
  });
}

void fill_bricks(const BoxTree& tree, const Placement& placement, const Vec3& pen_mm, HapticBrick& fine, HapticBrick& coarse,
                 const EarlierBrick& earlier_fine, const EarlierBrick& earlier_coarse) {
  const BrickShape of_fine = fine_shape(), of_coarse = coarse_shape();
  place_brick(of_fine, pen_mm, fine);
  place_brick(of_coarse, pen_mm, coarse);
  parallel_for(2 * kTasksOfBrick, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (i < kTasksOfBrick)
        fill_part(tree, placement, of_fine, fine, earlier_fine, i);
      else
        fill_part(tree, placement, of_coarse, coarse, earlier_coarse, i - kTasksOfBrick);
  });
}

namespace {

constexpr int kCount = 32;
constexpr double kFineHalfSize = 10;    // mm
constexpr double kMaxPenSpeed = 1500;   // mm/s
constexpr double kMaxAge = 0.020;       // s
constexpr double kReachSpacings = 4.5;  ///< base/haptic_field.h asks for 4

/// Rounding to every fourth node moves the pen up to two nodes from the brick's middle.
BrickShape shape_within(double half_size_mm) {
  const double spacing_mm = half_size_mm / (0.5 * (kCount - 1) - 0.5 * kBlockSide);
  return {spacing_mm, kCount, kReachSpacings * spacing_mm};
}

}  // namespace

BrickShape fine_shape() { return shape_within(kFineHalfSize); }
BrickShape coarse_shape() { return shape_within(kFineHalfSize + kMaxPenSpeed * kMaxAge); }

}  // namespace prismesh::mesh::field
