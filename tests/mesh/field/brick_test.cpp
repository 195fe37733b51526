#include "mesh/field/brick.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "tests/mesh/spatial/tree_trials.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::field {
namespace {

using spatial::BoxTree;

Placement turned(double scale) {
  Placement placement;
  placement.turn = (Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.5).normalized()) * Eigen::AngleAxisd(-0.3, Vec3::UnitZ())).toRotationMatrix();
  placement.shift_mm = Vec3(3, -700, 20);
  placement.scale = scale;
  return placement;
}

Vec3 node_mm(const HapticBrick& brick, int x, int y, int z) {
  return Vec3(brick.origin_mm[0], brick.origin_mm[1], brick.origin_mm[2]) + brick.spacing_mm * Vec3(x, y, z);
}
std::size_t index(const HapticBrick& brick, int x, int y, int z) {
  return static_cast<std::size_t>(x + brick.count[0] * (y + brick.count[1] * z));
}

std::unique_ptr<HapticBrick> filled(const BoxTree& tree, const Placement& placement, const BrickShape& shape, const Vec3& pen_mm) {
  auto brick = std::make_unique<HapticBrick>();
  fill_brick(tree, placement, shape, pen_mm, *brick);
  return brick;
}

/// The distances are those of all shells, computed in double precision, up to the reach; the elements are as near.
void expect_brick_of(const Model& model, const Placement& placement, const BrickShape& shape, const HapticBrick& brick, int step = 1) {
  const double rounding = 1e-6 * (shape.reach_mm + 4 * shape.spacing_mm);
  ASSERT_LT(rounding, 1e-4);
  int near = 0;
  for (int z = 0; z < shape.count; z += step)
    for (int y = 0; y < shape.count; y += step)
      for (int x = 0; x < shape.count; x += step) {
        const std::size_t at = index(brick, x, y, z);
        const double distance = brick.distance_mm[at];
        const Vec3 place = placement.to_model(node_mm(brick, x, y, z));
        const double plain = test::plain_nearest(model, place).distance * placement.scale;
        ASSERT_NEAR(distance, std::min(plain, shape.reach_mm), rounding) << x << ' ' << y << ' ' << z;
        if (brick.nearest[at] < 0) {
          ASSERT_GT(plain, shape.reach_mm - rounding);
          continue;
        }
        ++near;
        const double of_element =
            std::sqrt(test::plain_distance2(model, ShellIndex(static_cast<std::size_t>(brick.nearest[at])), place)) * placement.scale;
        ASSERT_NEAR(of_element, plain, 2 * rounding);
      }
  EXPECT_GT(near, 0);
}

/// Two neighbours differ by at most the spacing: the distance is 1-Lipschitz.
void expect_lipschitz(const HapticBrick& brick) {
  const double max = brick.spacing_mm * (1 + 1e-6) + 1e-6;
  for (int z = 0; z < brick.count[2]; ++z)
    for (int y = 0; y < brick.count[1]; ++y)
      for (int x = 0; x < brick.count[0]; ++x) {
        const float here = brick.distance_mm[index(brick, x, y, z)];
        ASSERT_TRUE(std::isfinite(here) && here >= 0);
        if (x > 0) {
          ASSERT_LE(std::abs(here - brick.distance_mm[index(brick, x - 1, y, z)]), max);
        }
        if (y > 0) {
          ASSERT_LE(std::abs(here - brick.distance_mm[index(brick, x, y - 1, z)]), max);
        }
        if (z > 0) {
          ASSERT_LE(std::abs(here - brick.distance_mm[index(brick, x, y, z - 1)]), max);
        }
      }
}

bool same(const HapticBrick& a, const HapticBrick& b) {
  const auto nodes = static_cast<std::size_t>(a.count[0] * a.count[1] * a.count[2]);
  return std::equal(a.origin_mm, a.origin_mm + 3, b.origin_mm) && std::equal(a.count, a.count + 3, b.count) &&
         std::equal(a.distance_mm, a.distance_mm + nodes, b.distance_mm) && std::equal(a.nearest, a.nearest + nodes, b.nearest);
}

/// A place on the model, in the pen's space.
Vec3 pen_on(const Model& model, const Placement& placement, std::size_t node) {
  while (!model.positions[node % model.node_count()].allFinite() || model.positions[node % model.node_count()].norm() > 1e6) ++node;
  return placement.to_pen(model.positions[node % model.node_count()]) + Vec3(0.3, 0.2, -0.4);
}

TEST(BrickTest, over_a_square_is_the_distance_from_it) {
  const Model model = test::make_shells({{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}}, {{0, 1, 2, 3}});
  const auto brick = filled(BoxTree(model), {}, {1, 16, 6}, Vec3(0, 0, 2));
  for (int z = 0; z < 16; ++z) {
    const double high = std::abs(node_mm(*brick, 0, 0, z).z());
    for (const int x : {0, 7, 15}) {
      EXPECT_FLOAT_EQ(brick->distance_mm[index(*brick, x, 3, z)], static_cast<float>(std::min(high, 6.0)));
      EXPECT_EQ(brick->nearest[index(*brick, x, 3, z)], high <= 6 ? 0 : -1);
    }
  }
}

TEST(BrickTest, lies_about_the_pen_on_the_lattice) {
  const BoxTree tree(test::junction());
  for (const BrickShape& shape : {fine_shape(), coarse_shape(), BrickShape{0.3, 12, 1}})
    for (const double x : {0.0, 0.1, 3.7, -17.3, 512.0}) {
      const Vec3 pen(x, -2 * x, x + 5);
      const auto brick = filled(tree, {}, shape, pen);
      const double half = ((shape.count - 1) / 2.0 - kBlockSide / 2.0) * shape.spacing_mm;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(brick->origin_mm[axis], pen[axis] - half + 1e-9);
        EXPECT_GE(brick->origin_mm[axis] + (shape.count - 1) * shape.spacing_mm, pen[axis] + half - 1e-9);
        const double block = brick->origin_mm[axis] / (kBlockSide * shape.spacing_mm);
        EXPECT_NEAR(block, std::round(block), 1e-9);
      }
    }
  const auto half_size = [](const BrickShape& shape) { return ((shape.count - 1) / 2.0 - kBlockSide / 2.0) * shape.spacing_mm; };
  EXPECT_NEAR(half_size(fine_shape()), 10, 1e-9);
  EXPECT_NEAR(half_size(coarse_shape()), 40, 1e-9);
  EXPECT_GE(fine_shape().reach_mm, 4 * fine_shape().spacing_mm);
  EXPECT_GE(coarse_shape().reach_mm, 4 * coarse_shape().spacing_mm);
}

TEST(BrickTest, distances_are_those_of_all_shells) {
  std::size_t node = 57;
  for (const Model& model : {test::folded_sheet(), test::junction(), test::spoiled_sheet()}) {
    const BoxTree tree(model);
    // shells much larger than the spacing, of about its size, and much smaller: by lists, and node by node
    for (const double scale : {20.0, 1.0, 0.05}) {
      const Placement placement = turned(scale);
      for (const double reach : {2.0, 5.0}) {
        const BrickShape shape{0.7, 20, reach};
        const auto brick = filled(tree, placement, shape, pen_on(model, placement, node += 41));
        expect_brick_of(model, placement, shape, *brick, 3);
        expect_lipschitz(*brick);
      }
    }
  }
}

TEST(BrickTest, of_equally_near_shells_takes_the_first) {
  Model model = test::make_grid(6, 6, [](int i, int j) { return Vec3(i, j, 0); });
  for (std::size_t s = 0; s < 36; ++s)
    add_shell(model, 500 + static_cast<std::int64_t>(s), ShellNodes(model.shell_nodes[s]), ShellIndex(s));
  const auto brick = filled(BoxTree(model), {}, {0.5, 16, 2}, Vec3(3, 3, 0));
  for (int i = 0; i < 16 * 16 * 16; ++i) EXPECT_LT(brick->nearest[i], 36);
}

TEST(BrickTest, far_from_all_shells_holds_the_reach) {
  for (const Model& model : {test::junction(), Model()}) {
    const auto brick = filled(BoxTree(model), {}, {0.5, 16, 2}, Vec3(300, 3, 0));
    for (int i = 0; i < 16 * 16 * 16; ++i) {
      ASSERT_EQ(brick->distance_mm[i], 2.0F);
      ASSERT_EQ(brick->nearest[i], -1);
    }
  }
}

TEST(BrickTest, both_bricks_at_once_are_those_one_by_one) {
  const Model model = test::folded_sheet();
  const BoxTree tree(model);
  const Placement placement = turned(3);
  const Vec3 pen = pen_on(model, placement, 100);
  const auto fine = std::make_unique<HapticBrick>(), coarse = std::make_unique<HapticBrick>();
  fill_bricks(tree, placement, pen, *fine, *coarse);
  EXPECT_TRUE(same(*fine, *filled(tree, placement, fine_shape(), pen)));
  EXPECT_TRUE(same(*coarse, *filled(tree, placement, coarse_shape(), pen)));
  expect_brick_of(model, placement, fine_shape(), *fine, 5);
  expect_brick_of(model, placement, coarse_shape(), *coarse, 5);
  expect_lipschitz(*fine);
  expect_lipschitz(*coarse);
}

TEST(BrickTest, a_brick_from_an_earlier_one_has_the_same_bits) {
  const Model model = test::folded_sheet();
  const BoxTree tree(model);
  for (const double scale : {6.0, 0.2}) {
    const Placement placement = turned(scale);
    const BrickShape shape{0.5, 24, 2.2};
    Vec3 pen = pen_on(model, placement, 100);
    auto earlier = filled(tree, placement, shape, pen);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> step(-3, 3);
    for (int i = 0; i < 6; ++i) {
      pen += Vec3(step(random), step(random), i == 4 ? 40.0 : 0.0);
      auto brick = std::make_unique<HapticBrick>();
      fill_brick(tree, placement, shape, pen, *brick, {earlier.get(), {}});
      EXPECT_TRUE(same(*brick, *filled(tree, placement, shape, pen)));
      earlier = std::move(brick);
    }
  }
}

TEST(BrickTest, after_edits_is_that_of_a_new_tree) {
  std::mt19937 random(8);
  Model model = test::with_adjacency(test::folded_sheet());
  BoxTree tree(model);
  for (const double scale : {6.0, 0.3}) {
    const Placement placement = turned(scale);
    const BrickShape shape{0.5, 24, 2.2};
    const Vec3 pen = pen_on(model, placement, 250);
    auto earlier = filled(tree, placement, shape, pen);
    for (int edit = 0; edit < 6; ++edit) {
      if (edit % 2 == 0) {
        model = test::edited_at_random(std::move(model), random);
      } else {  // a small change on one side
        model.positions.set(5, Vec3(model.positions[5] + Vec3(0, 0, 0.3)));
      }
      const auto update = tree.follow(model);
      auto brick = std::make_unique<HapticBrick>();
      fill_brick(tree, placement, shape, pen + Vec3(edit, 0, 0), *brick, {earlier.get(), update.changed});
      EXPECT_TRUE(same(*brick, *filled(BoxTree(model), placement, shape, pen + Vec3(edit, 0, 0)))) << edit;
      earlier = std::move(brick);
    }
    expect_brick_of(model, placement, shape, *earlier, 4);
  }
}

TEST(BrickTest, real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  for (const char* name : {"hatprofile", "boxbeam_rad", "gsa_car6_comma"}) {
    const Model model = test::open_real(*decks, name);
    ASSERT_GT(model.shell_count(), 0u) << name;
    const BoxTree tree(model);
    const Vec3 side = model.position(model.shell_nodes[0].node[1]) - model.position(model.shell_nodes[0].node[0]);
    for (const double scale : {4 / side.norm(), 0.3 / side.norm()}) {
      const Placement placement = turned(scale);
      const BrickShape shape = fine_shape();
      const auto brick =
          filled(tree, placement, shape, placement.to_pen(model.position(model.shell_nodes[model.shell_count() / 2].node[0])));
      expect_brick_of(model, placement, shape, *brick, 6);
      expect_lipschitz(*brick);
    }
  }
}

}  // namespace
}  // namespace prismesh::mesh::field
