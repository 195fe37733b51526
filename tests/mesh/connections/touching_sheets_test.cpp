#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/connections/find_joined_sheets.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::connections {
namespace {

/// Sheets of 4 x 4 shells of size 10, each of a part of its own; the shells of sheet s are 16 s .. 16 s + 15.
Model grids(const std::vector<std::function<Vec3(int, int)>>& places, double thickness,
            const std::vector<test::ElementSpec>& elements = {}) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::size_t s = 0; s < places.size(); ++s) {
    const auto first = static_cast<std::int64_t>(100 * s);
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 4; ++i) nodes.push_back({first + 1 + i + 5 * j, places[s](i, j)});
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const std::int64_t a = first + 1 + i + 5 * j;
        shells.push_back({first + 1 + i + 4 * j, static_cast<std::int64_t>(s + 1), {a, a + 1, a + 6, a + 5}});
      }
  }
  const Model model = test::make_model(nodes, shells, elements);
  return thickness > 0 ? test::with_thickness(model, thickness) : model;
}

std::function<Vec3(int, int)> level(double z) {
  return [z](int i, int j) { return Vec3(10 * i + 3 * z, 10 * j + 2 * z, z); };
}
/// Turned about the edge at x = 0, which is `z` above the first sheet.
std::function<Vec3(int, int)> tilted(double z, double run, double rise) {
  return [=](int i, int j) { return Vec3(1 + run * i, 10 * j, z + rise * i); };
}

/// Whether the sheets of these numbers, from 0, are joined.
bool joined(const Model& model, std::size_t a, std::size_t b, OutOfSight hidden = {}) {
  const JoinedSheets sheets = find_joined_sheets(model, {}, hidden);
  for (const auto& [one, other] : sheets.all())
    if (one.value / 16 == a && other.value / 16 == b) return true;
  return false;
}

TEST(TouchingSheets, are_joined_up_to_a_distance_by_thickness) {
  EXPECT_TRUE(joined(grids({level(0), level(1.19)}, 1), 0, 1));
  EXPECT_FALSE(joined(grids({level(0), level(1.21)}, 1), 0, 1));
  EXPECT_FALSE(joined(grids({level(0), level(0.5)}, 0), 0, 1)) << "nothing is known of unknown thickness";
}

TEST(TouchingSheets, are_joined_if_they_lie_flat_on_each_other) {
  EXPECT_TRUE(joined(grids({level(0), tilted(0.5, 10, 17)}, 1), 0, 1)) << "59.5 degrees";
  EXPECT_FALSE(joined(grids({level(0), tilted(0.5, 10, 18)}, 1), 0, 1)) << "60.9 degrees";
}

TEST(TouchingSheets, arent_joined_by_joints) {
  EXPECT_TRUE(find_joints(grids({level(0), level(1)}, 1), {}, {}).empty());
  const test::ElementSpec weld{ElementClass::beam, 1, 9, {13, 113}};
  const Model welded = grids({level(0), level(1), level(2)}, 1, {weld});
  const auto joints = find_joints(welded, {}, {});
  EXPECT_EQ(joints.size(), 16u) << "four shells at each end";
  for (const auto& [one, other] : joints) EXPECT_TRUE(one.value < 16 && other.value >= 16 && other.value < 32);
}

TEST(TouchingSheets, are_joined_only_where_no_joint_says_more) {
  const std::vector<std::function<Vec3(int, int)>> stack{level(0), level(1), level(2)};
  const test::ElementSpec weld{ElementClass::beam, 1, 9, {13, 113}}, other_weld{ElementClass::beam, 2, 9, {113, 213}};
  const Model plain = grids(stack, 1);
  EXPECT_TRUE(joined(plain, 0, 1) && joined(plain, 1, 2));
  EXPECT_FALSE(joined(plain, 0, 2));
  const Model welded = grids(stack, 1, {weld});
  EXPECT_TRUE(joined(welded, 0, 1) && joined(welded, 1, 2)) << "the third has no joint";
  EXPECT_EQ(find_joined_sheets(grids(stack, 1, {weld, other_weld}), {}, {}).of(ShellIndex(std::size_t{0})).size(), 0u)
      << "far from the welds";
  // two pairs that are welded, and touch each other
  const Model pairs = grids({level(0), level(1), level(2), level(3)}, 1, {weld, {ElementClass::beam, 2, 9, {213, 313}}});
  EXPECT_FALSE(joined(pairs, 1, 2));
}

TEST(TouchingSheets, are_not_joined_to_hidden_ones) {
  const std::vector<std::uint8_t> second_hidden{0, 1};
  EXPECT_FALSE(joined(grids({level(0), level(1)}, 1), 0, 1, second_hidden));
}

TEST(TouchingSheets, are_found_where_coordinates_are_no_numbers) {
  const Model model = grids({level(0), level(1)}, 1);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double odd : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e300}) {
    Model broken = model;
    broken.positions.set(7, Vec3(odd, 0, odd));
    EXPECT_TRUE(joined(broken, 0, 1)) << odd;
  }
}

TEST(Sheets, are_connected_over_shared_nodes) {
  // the second shell shares a node with the first, the third none
  const Model model = test::make_model(
      {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {2, 0, 0}}, {5, {2, 1, 0}}, {6, {5, 0, 0}}, {7, {6, 0, 0}}, {8, {6, 1, 0}}},
      {{1, 1, {1, 2, 3}}, {2, 2, {2, 4, 5}}, {3, 1, {6, 7, 8}}});
  const JoinedSheets sheets = find_joined_sheets(model, {}, {});
  const auto of = [&](std::size_t shell) { return sheets.sheet_of(ShellIndex(shell)); };
  EXPECT_EQ(of(0), of(1));
  EXPECT_NE(of(0), of(2));
}

}  // namespace
}  // namespace prismesh::mesh::connections
