#include "mesh/field/haptic_field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh/field/moved_triangles.h"
#include "tests/mesh/spatial/tree_trials.h"

namespace prismesh::mesh::field {
namespace {

using spatial::BoxTree;

struct Step {
  std::unique_ptr<HapticField> field = std::make_unique<HapticField>();
  BoxTree tree;
  Model model;
};

Step first_step(const Model& model, const Placement& placement, const Vec3& pen) {
  Step step;
  step.model = model;
  step.tree = BoxTree(model);
  fill_field({&step.tree, 1}, {}, placement, pen, *step.field);
  return step;
}

Step next_step(const Step& before, const Model& model, const Placement& placement, const Vec3& pen) {
  Step step;
  step.model = model;
  step.tree = before.tree;
  const auto update = step.tree.follow(model);
  fill_field({&step.tree, 2}, {before.field.get(), {&before.tree, 1}, update.changed}, placement, pen, *step.field);
  return step;
}

/// The triangles of a shell in both states, in the pen's space.
struct Motion {
  ShellIndex shell;
  std::array<Vec3, 3> from, to;
};
std::vector<Motion> motions_of(const Model& before, const Model& now, const Placement& placement) {
  std::vector<Motion> motions;
  for (std::size_t s = 0; s < now.shell_count(); ++s) {
    std::vector<std::array<Vec3, 3>> from, to;
    const auto add = [&](auto& list) {
      return [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        list.push_back({placement.to_pen(a), placement.to_pen(b), placement.to_pen(c)});
      };
    };
    test::each_trial_triangle(before, ShellIndex(s), add(from));
    test::each_trial_triangle(now, ShellIndex(s), add(to));
    for (std::size_t t = 0; t < to.size(); ++t)
      if (from[t] != to[t]) motions.push_back({ShellIndex(s), from[t], to[t]});
  }
  return motions;
}

/// Places of a moving triangle's corners, sides and middle, over the time of its motion.
std::vector<Vec3> places_of(const Motion& motion) {
  std::vector<Vec3> places;
  for (int t = 0; t <= 8; ++t)
    for (int u = 0; u <= 4; ++u)
      for (int v = 0; u + v <= 4; ++v) {
        const double time = t / 8.0, a = u / 4.0, b = v / 4.0;
        const auto corner = [&](std::size_t i) -> Vec3 { return (1 - time) * motion.from[i] + time * motion.to[i]; };
        places.push_back((1 - a - b) * corner(0) + a * corner(1) + b * corner(2));
      }
  return places;
}

/// Each triangle that comes near is listed with its places, in every bucket that it comes near.
void expect_motions_of(const Step& before, const Step& now, const Placement& placement) {
  const HapticField& field = *now.field;
  ASSERT_EQ(field.before_generation, 1u);
  EXPECT_GE(field.moved_reach_mm, 2 * field.fine.spacing_mm);
  std::set<std::array<float, 18>> listed;
  std::vector<std::array<float, 18>> order;
  for (std::int32_t i = 0; i < field.moved_count; ++i) {
    std::array<float, 18> numbers;
    std::copy_n(&field.moved[i].before_mm[0][0], 9, numbers.begin());
    std::copy_n(&field.moved[i].now_mm[0][0], 9, numbers.begin() + 9);
    listed.insert(numbers);
    order.push_back(numbers);
    for (const auto& corners : {field.moved[i].before_mm, field.moved[i].now_mm})
      for (int c = 1; c < 3; ++c)
        EXPECT_LE(std::hypot(corners[c][0] - corners[0][0], corners[c][1] - corners[0][1], corners[c][2] - corners[0][2]),
                  field.moved[i].radius_mm);
    if (i > 0) {
      EXPECT_LE(field.moved[i - 1].element, field.moved[i].element);
    }
  }
  EXPECT_EQ(field.bucket_begin[0], 0u);
  const double size = field.fine.spacing_mm * (field.fine.count[0] - 1);
  const Vec3 low(field.fine.origin_mm[0], field.fine.origin_mm[1], field.fine.origin_mm[2]);
  std::size_t near = 0;
  for (const Motion& motion : motions_of(before.model, now.model, placement)) {
    std::array<float, 18> numbers;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        numbers[3 * c + axis] = static_cast<float>(motion.from[c][static_cast<Eigen::Index>(axis)]);
        numbers[9 + 3 * c + axis] = static_cast<float>(motion.to[c][static_cast<Eigen::Index>(axis)]);
        EXPECT_LE((motion.to[c] - motion.from[c]).norm(), field.max_moved_mm * (1 + 1e-12));
      }
    for (const Vec3& place : places_of(motion)) {
      const Vec3 outside = (low - place).cwiseMax(place - low - Vec3::Constant(size)).cwiseMax(Vec3::Zero());
      if (outside.norm() > field.moved_reach_mm) continue;
      ++near;
      ASSERT_TRUE(listed.contains(numbers)) << motion.shell.value;
      int at = 0;
      for (int axis = 2; axis >= 0; --axis)
        at = kBucketSide * at + std::clamp(static_cast<int>((place[axis] - low[axis]) / size * kBucketSide), 0, kBucketSide - 1);
      const auto begin = field.bucket_begin[at], end = field.bucket_begin[at + 1];
      bool found = false;
      for (auto e = begin; e < end; ++e) found = found || order[field.bucket_entry[e]] == numbers;
      ASSERT_TRUE(found);
    }
  }
  EXPECT_GT(near, 0u);
}

/// Without the shells that moved, the distances are those of the others.
void expect_still_of(const Step& before, const Step& now, const Placement& placement) {
  std::set<ShellIndex> moved;
  for (const Motion& motion : motions_of(before.model, now.model, placement)) moved.insert(motion.shell);
  Model still = now.model;
  for (const ShellIndex shell : moved) remove_shell(still, shell);
  const BoxTree tree(still);
  const auto fine = std::make_unique<HapticBrick>(), coarse = std::make_unique<HapticBrick>();
  const Vec3 pen = Vec3(now.field->fine.origin_mm[0], now.field->fine.origin_mm[1], now.field->fine.origin_mm[2]) +
                   Vec3::Constant(15.5 * now.field->fine.spacing_mm);
  fill_brick(tree, placement, fine_shape(), pen, *fine);
  const std::size_t nodes = 32 * 32 * 32;
  EXPECT_TRUE(std::equal(fine->distance_mm, fine->distance_mm + nodes, now.field->fine.still_mm));
  for (std::size_t i = 0; i < nodes; ++i) {
    ASSERT_GE(now.field->coarse.still_mm[i], now.field->coarse.distance_mm[i] - 1e-5);
    ASSERT_GE(now.field->fine.still_mm[i], now.field->fine.distance_mm[i] - 1e-5);
  }
}

Model sheet() {
  return test::make_grid(30, 30, [](int i, int j) { return Vec3(i, j, 0.2 * test::noise(i, j, 1)); });
}

Model lifted(Model model, int from, int to, double by) {
  for (int i = from; i <= to; ++i)
    for (int j = from; j <= to; ++j) {
      const std::size_t n = test::grid_node(30, i, j).value;
      model.positions.set(n, Vec3(model.positions[n] + Vec3(0.1 * by, 0, by)));
    }
  return model;
}

TEST(HapticFieldTest, lists_what_moved_near_the_pen) {
  Placement placement;
  placement.turn = Eigen::AngleAxisd(0.4, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  placement.shift_mm = Vec3(1, 2, 3);
  const Model start = sheet();
  for (const auto& [scale, by] :
       {std::pair(2.0, 0.5), std::pair(2.0, -3.0), std::pair(2.0, 4.0), std::pair(8.0, 0.5), std::pair(8.0, -2.0)}) {
    placement.scale = scale;
    const Vec3 pen = placement.to_pen(Vec3(14, 13, 1));
    const Step before = first_step(start, placement, pen);
    const Step now = next_step(before, lifted(start, 11, 16, by), placement, pen + Vec3(2, 0, 0));
    expect_motions_of(before, now, placement);
    expect_still_of(before, now, placement);
  }
}

TEST(HapticFieldTest, is_the_same_from_an_earlier_one) {
  const Model start = sheet();
  Placement placement;
  placement.scale = 5;
  const Vec3 pen = placement.to_pen(Vec3(9, 9, 0));
  const Step before = first_step(start, placement, pen);
  const Step now = next_step(before, lifted(start, 11, 16, 0.4), placement, pen + Vec3(5, 3, 0));
  const Step fresh = first_step(now.model, placement, pen + Vec3(5, 3, 0));
  EXPECT_EQ(fresh.field->before_generation, 0u);
  EXPECT_EQ(fresh.field->max_moved_mm, 0);
  EXPECT_EQ(now.field->mesh_generation, 2u);
  const std::size_t nodes = 32 * 32 * 32;
  for (const auto& [a, b] : {std::pair(&now.field->fine, &fresh.field->fine), std::pair(&now.field->coarse, &fresh.field->coarse)}) {
    EXPECT_TRUE(std::equal(a->distance_mm, a->distance_mm + nodes, b->distance_mm));
    EXPECT_TRUE(std::equal(a->nearest, a->nearest + nodes, b->nearest));
    EXPECT_TRUE(std::equal(b->still_mm, b->still_mm + nodes, b->distance_mm));
  }
}

TEST(HapticFieldTest, nothing_moved) {
  const Model start = sheet();
  const Vec3 pen(15, 15, 1);
  const Step before = first_step(start, {}, pen);
  const Step now = next_step(before, start, {}, pen);
  EXPECT_EQ(now.field->before_generation, 1u);
  EXPECT_EQ(now.field->max_moved_mm, 0);
  EXPECT_EQ(now.field->moved_count, 0);
  EXPECT_EQ(now.field->bucket_begin[kBuckets], 0u);
}

TEST(HapticFieldTest, lets_go_where_shells_appear_or_disappear) {
  const Model start = sheet();
  const Vec3 pen(15, 15, 1);
  Placement placement;
  placement.scale = 8;  // the brick holds a part of the sheet
  const Vec3 pen_mm = placement.to_pen(pen);
  const Step before = first_step(start, placement, pen_mm);
  const auto generation_after = [&](const Model& model) {
    return next_step(before, test::with_adjacency(model), placement, pen_mm).field->before_generation;
  };
  const ShellIndex here(std::size_t{15 * 30 + 15}), far(std::size_t{0});
  for (const auto& [shell, expected] : {std::pair(here, 0u), std::pair(far, 1u)}) {
    Model removed = start;
    remove_shell(removed, shell);
    EXPECT_EQ(generation_after(removed), expected);
    Model added = start;
    add_shell(added, 7000, ShellNodes(start.shell(shell)), shell);
    EXPECT_EQ(generation_after(added), expected);
    Model reshaped = start;
    const auto [a, b, c, d] = start.shell(shell).node;
    set_shell_nodes(reshaped, shell, {{b, c, d, a}});
    EXPECT_EQ(generation_after(reshaped), expected);
    Model lost = start;
    lost.positions.set(start.shell(shell).node[1].value, Vec3(0, std::nan(""), 0));
    EXPECT_EQ(generation_after(lost), expected);
  }
}

TEST(HapticFieldTest, lets_go_of_more_than_there_is_room_for) {
  const Model start = test::make_grid(100, 100, [](int i, int j) { return Vec3(i, j, 0); });
  Model moved = start;
  for (std::size_t n = 0; n < start.node_count(); ++n) moved.positions.set(n, Vec3(start.positions[n] + Vec3(0, 0, 0.1)));
  Placement placement;
  placement.scale = 0.3;
  const auto expect_unknown = [](const Step& now) {
    EXPECT_EQ(now.field->before_generation, 0u);
    EXPECT_EQ(now.field->moved_count, 0);
    EXPECT_EQ(now.field->max_moved_mm, 0);
  };
  const Vec3 pen = placement.to_pen(Vec3(50, 50, 0));
  expect_unknown(next_step(first_step(start, placement, pen), moved, placement, pen));  // some 15,000 triangles
  // few triangles that sweep through the whole brick, each in all buckets
  placement.scale = 2;
  const Vec3 above = placement.to_pen(Vec3(14, 13, 1));
  expect_unknown(next_step(first_step(sheet(), placement, above), lifted(sheet(), 6, 22, 20), placement, above));
}

}  // namespace
}  // namespace prismesh::mesh::field
