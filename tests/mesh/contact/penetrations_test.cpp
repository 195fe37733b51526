#include "mesh/contact/find_penetrations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/contact/joints_of_parts.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

using test::SheetsThatMeet;

constexpr double kRadianPerDegree = 3.14159265358979323846 / 180;

std::vector<Penetration> penetrations_of(const Model& model, const ContactThickness& thickness, const PenetrationWish& wish = {}) {
  const spatial::BoxTree tree(model);
  return find_penetrations(model, tree, thickness, find_shell_crossings(model, tree), wish);
}
std::vector<Penetration> penetrations_of(const SheetsThatMeet& sheets, double thickness, double gap = 0) {
  const Model model = sheets.model();
  return penetrations_of(model, given_thickness(model, thickness), {gap, nullptr});
}

/// A plate of 10 x 10 shells of size 1, and one of 4 x 4 above it, 0.3 off its nodes.
SheetsThatMeet plate_below(double height) {
  SheetsThatMeet sheets;
  return sheets.add_plate(1).add(2, 4, 4, [=](int i, int j) { return Vec3(i - 1.7, j - 1.7, height); });
}

TEST(Penetrations, of_parallel_plates) {
  for (const double height : {0.9, 0.5, 0.25, -0.125, 0x1p-20}) {
    const auto found = penetrations_of(plate_below(height), 1);
    ASSERT_EQ(found.size(), 1u) << height;
    const Penetration& region = found.front();
    EXPECT_EQ(region.part_a, PartIndex(0));
    EXPECT_EQ(region.part_b, PartIndex(1));
    EXPECT_NEAR(region.max_depth, 1 - std::abs(height), 1e-12);
    EXPECT_NEAR(region.mean_depth, 1 - std::abs(height), 1e-12);
    EXPECT_EQ(region.shells_b.size(), 16u);
    EXPECT_GE(region.shells_a.size(), 25u) << "-1.7 to 2.3 lies over five rows";
    EXPECT_NEAR(region.area, 16, 1e-12);
    EXPECT_FALSE(region.is_clearance);
    ASSERT_EQ(region.nodes_b.size(), 25u);
    for (const WayOut& way : region.nodes_b) {
      EXPECT_NEAR(way.depth, 1 - std::abs(height), 1e-12);
      EXPECT_NEAR(way.direction.z(), height > 0 ? 1 : -1, 1e-12);
    }
  }
}

TEST(Penetrations, none_where_plates_are_far_enough_apart) {
  EXPECT_TRUE(penetrations_of(plate_below(1), 1).empty());
  EXPECT_TRUE(penetrations_of(plate_below(1.5), 1).empty());
  EXPECT_TRUE(penetrations_of(plate_below(1 - kMinDepthShare / 2), 1).empty()) << "less deep than decks are exact";
  EXPECT_EQ(penetrations_of(plate_below(1 - kMinDepthShare * 2), 1).size(), 1u);
}

TEST(Penetrations, of_plates_of_two_thicknesses) {
  const Model model = plate_below(0.8).model();
  ContactThickness thickness = given_thickness(model, 1.5);
  for (std::size_t s = 100; s < model.shell_count(); ++s) thickness.of_shell[s] = 0.5;
  const auto found = penetrations_of(model, thickness);
  ASSERT_EQ(found.size(), 1u) << "whichever of the two is thicker";
  EXPECT_NEAR(found.front().max_depth, 0.2, 1e-12);
  std::replace(thickness.of_shell.begin(), thickness.of_shell.end(), 1.5, 0.25);
  EXPECT_TRUE(penetrations_of(model, thickness).empty());
}

TEST(Penetrations, of_inclined_plates) {
  for (const double degrees : {1.0, 5.0, 20.0, 45.0, 70.0}) {
    SheetsThatMeet sheets;  // the lowest row at the height 0.4
    sheets.add_plate(1).add(2, 4, 4, [=](int i, int j) {
      return Vec3(i - 1.7, 0.3 + j * std::cos(degrees * kRadianPerDegree), 0.4 + j * std::sin(degrees * kRadianPerDegree));
    });
    const auto found = penetrations_of(sheets, 1);
    ASSERT_EQ(found.size(), 1u) << degrees;
    EXPECT_NEAR(found.front().max_depth, 0.6, 1e-12);
    EXPECT_EQ(found.front().nodes_b.size(),
              5 * static_cast<std::size_t>(std::ceil(std::min(5.0, (0.6 - 0.01) / std::sin(degrees * kRadianPerDegree)))))
        << "the rows below the height 1";
    EXPECT_LE(found.front().mean_depth, 0.6 + 1e-12);
  }
}

TEST(Penetrations, of_an_edge_above_an_edge) {
  SheetsThatMeet blades;  // each one shell, no corner near the other one
  blades.add(1, 1, 1, [](int i, int j) { return Vec3(10 * i - 5, 0, -3 * j); });
  blades.add(2, 1, 1, [](int i, int j) { return Vec3(0.5, 10 * i - 5, 0.25 + 3 * j); });
  const auto found = penetrations_of(blades, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found.front().max_depth, 0.75, 1e-12);
  EXPECT_NEAR((found.front().worst.on_a - Vec3(0.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((found.front().worst.on_b - Vec3(0.5, 0, 0.25)).norm(), 0, 1e-12);
  EXPECT_TRUE(found.front().nodes_a.empty());
}

TEST(Penetrations, of_strips_that_cross_above_each_other) {
  SheetsThatMeet strips;
  strips.add(1, 1, 1, [](int i, int j) { return Vec3(10 * i - 5, j, 0); });
  strips.add(2, 1, 1, [](int i, int j) { return Vec3(j, 10 * i - 5, 0.25); });
  ASSERT_EQ(penetrations_of(strips, 1).size(), 1u);
  EXPECT_NEAR(penetrations_of(strips, 1).front().max_depth, 0.75, 1e-12);
}

/// Adds a grid whose last column is its first.
void add_closed(SheetsThatMeet& sheets, std::int64_t part, int columns, int rows, const std::function<Vec3(int i, int j)>& place) {
  const auto first = static_cast<std::int64_t>(sheets.nodes.size()) + 1;
  const std::size_t first_shell = sheets.shells.size();
  sheets.add(part, columns, rows, place);
  for (std::size_t s = first_shell; s < sheets.shells.size(); ++s)
    for (std::int64_t& node : sheets.shells[s].nodes)
      if ((node - first) % (columns + 1) == columns) node -= columns;
}

TEST(Penetrations, of_a_sphere_in_a_tube) {
  constexpr int kAround = 36;
  const auto at = [](double radius, int i, double height) {
    const double turn = 360.0 * i / kAround * kRadianPerDegree;
    return Vec3(radius * std::cos(turn), radius * std::sin(turn), height);
  };
  SheetsThatMeet sheets;
  add_closed(sheets, 1, kAround, 10, [&](int i, int j) { return at(10, i, 2 * j - 10); });
  add_closed(sheets, 2, kAround, 16, [&](int i, int j) {
    const double up = (-80 + 160.0 * j / 16) * kRadianPerDegree;
    return at(9.2 * std::cos(up), i, 9.2 * std::sin(up));
  });
  EXPECT_TRUE(penetrations_of(sheets, 0.7).empty());
  const auto found = penetrations_of(sheets, 1.2);
  ASSERT_EQ(found.size(), 1u) << "a ring about the equator";
  EXPECT_NEAR(found.front().max_depth, 0.4, 0.02) << "of the facets";
  EXPECT_NEAR(found.front().worst.on_b.z(), 0, 1e-9);
  EXPECT_EQ(found.front().shells_a.size() % kAround, 0u);
  EXPECT_EQ(found.front().shells_b.size() % kAround, 0u);
}

TEST(Penetrations, of_a_sheet_with_itself) {
  // A hairpin: flat from x = 0 to 20, half a circle of radius `radius`, and back above itself.
  const auto hairpin = [](double radius) {
    SheetsThatMeet sheets;
    return sheets.add(1, 46, 4, [=](int i, int j) {
      if (i <= 20) return Vec3(i, j, 0);
      if (i >= 26) return Vec3(46 - i, j, 2 * radius);
      const double turn = (i - 20) * 30 * kRadianPerDegree;
      return Vec3(20 + radius * std::sin(turn), j, radius * (1 - std::cos(turn)));
    });
  };
  const auto found = penetrations_of(hairpin(0.4), 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found.front().max_depth, 0.2, 1e-12);
  EXPECT_EQ(found.front().part_a, found.front().part_b);
  EXPECT_FALSE(std::binary_search(found.front().shells_a.begin(), found.front().shells_a.end(), found.front().shells_b.front()));
  EXPECT_TRUE(penetrations_of(hairpin(0.6), 1).empty());
}

TEST(Penetrations, none_in_a_finely_meshed_sheet) {
  const auto folded = [](double size, double degrees) {  // an edge with this angle, and waves along it
    SheetsThatMeet sheets;
    return sheets.add(1, 16, 6, [=](int i, int j) {
      const double along = (i - 8) * size, wave = 0.1 * size * std::sin(j);
      if (along <= 0) return Vec3(along, j * size, wave);
      return Vec3(-along * std::cos(degrees * kRadianPerDegree), j * size, along * std::sin(degrees * kRadianPerDegree) + wave);
    });
  };
  for (const double degrees : {180.0, 135.0, 90.0, 60.0, 40.0})
    for (const double size : {0.3, 0.9}) EXPECT_TRUE(penetrations_of(folded(size, degrees), 1).empty()) << degrees << " " << size;
  EXPECT_FALSE(penetrations_of(folded(0.5, 10), 1).empty()) << "so narrow that its sides are too close";
}

TEST(Penetrations, none_at_a_junction) {
  const auto standing = [](double height, double size, double tilt = 0) {
    SheetsThatMeet sheets;
    return sheets.add_plate(1).add(2, 6, 6, [=](int i, int j) { return Vec3(i - 2.8, 0.3 + tilt * size * j, height + size * j); });
  };
  EXPECT_TRUE(penetrations_of(standing(0, 1), 0.8).empty()) << "the edge lies in the plate";
  EXPECT_TRUE(penetrations_of(standing(0, 0.25), 0.8).empty()) << "several rows are too close";
  EXPECT_TRUE(penetrations_of(standing(0, 0.25, 0.7), 0.8).empty());
  const auto above = penetrations_of(standing(0.5, 1), 0.8);
  ASSERT_EQ(above.size(), 1u) << "the edge is near the plate without touching it";
  EXPECT_NEAR(above.front().max_depth, 0.3, 1e-12);
}

TEST(Penetrations, of_a_sheet_that_bends_from_a_junction_to_the_plate) {
  SheetsThatMeet sheets;  // rises from the plate, and comes back to 0.25 above it
  sheets.add_plate(1).add(2, 6, 8, [](int i, int j) {
    constexpr double kY[] = {0, 0, 0, 1, 2, 2.2, 2.4, 3.4, 4.4}, kZ[] = {0, 1, 2, 2, 2, 1, 0.25, 0.25, 0.25};
    return Vec3(i - 2.8, kY[j] - 2.7, kZ[j]);
  });
  const auto found = penetrations_of(sheets, 0.5);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found.front().max_depth, 0.25, 1e-12);
}

TEST(Penetrations, none_along_a_seam) {
  for (const double gap : {0.0, 0x1p-30, 0.1, 0.5})
    for (const double size : {0.3, 1.0}) {
      SheetsThatMeet sheets;
      sheets.add(1, 6, 6, [=](int i, int j) { return Vec3(size * (i - 6), size * j, 0); });
      sheets.add(2, 6, 6, [=](int i, int j) { return Vec3(size * i + gap, size * j, 0.2 * size * i); });
      EXPECT_TRUE(penetrations_of(sheets, 0.8).empty()) << gap << " " << size;
    }
  SheetsThatMeet corner;  // at a right angle, with nodes of their own
  corner.add(1, 6, 6, [](int i, int j) { return Vec3(0.3 * (i - 6), 0.3 * j, 0); });
  corner.add(2, 6, 6, [](int i, int j) { return Vec3(0, 0.3 * j, 0.3 * i); });
  EXPECT_TRUE(penetrations_of(corner, 0.8).empty());
}

TEST(Penetrations, of_plates_in_one_plane) {
  SheetsThatMeet same;
  same.add_plate(1).add_plate(2);
  const auto found = penetrations_of(same, 0.5);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().max_depth, 0.5) << "one sheet is there twice";
  EXPECT_GE(found.front().shells_a.size(), 64u);
}

TEST(Penetrations, none_where_the_sheets_cross) {
  SheetsThatMeet sheets;  // crosses the plate at a small angle, and is too close to it on both sides
  sheets.add_plate(1).add(2, 6, 4, [](int i, int j) { return Vec3(i - 2.8, j - 1.7, 0.1 * (j - 1.7)); });
  sheets.add(3, 2, 2, [](int i, int j) { return Vec3(i - 4.8, j - 4.8, 0.5); });
  const auto found = penetrations_of(sheets, 1);
  ASSERT_EQ(found.size(), 1u) << "the third part's";
  EXPECT_EQ(found.front().part_b, PartIndex(2));
}

TEST(Penetrations, each_region_by_itself_the_deepest_first) {
  SheetsThatMeet sheets;
  sheets.add_plate(1);
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i - 4.3, j - 4.3, 0.6); });
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i + 1.7, j + 1.7, 0.3); });
  const auto found = penetrations_of(sheets, 1);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].max_depth, 0.7, 1e-12);
  EXPECT_NEAR(found[1].max_depth, 0.4, 1e-12);
  EXPECT_TRUE(std::any_of(found[0].pairs.begin(), found[0].pairs.end(),
                          [&](const CloseShells& pair) { return pair.a == found[0].worst.a && pair.b == found[0].worst.b; }));
}

TEST(Penetrations, with_a_gap_are_clearances_unless_the_faces_meet) {
  const auto apart = penetrations_of(plate_below(1.25), 1, 0.5);
  ASSERT_EQ(apart.size(), 1u);
  EXPECT_TRUE(apart.front().is_clearance);
  EXPECT_NEAR(apart.front().max_depth, 0.25, 1e-12);
  const auto close = penetrations_of(plate_below(0.75), 1, 0.5);
  ASSERT_EQ(close.size(), 1u);
  EXPECT_FALSE(close.front().is_clearance);
  EXPECT_NEAR(close.front().max_depth, 0.75, 1e-12);
  EXPECT_TRUE(penetrations_of(plate_below(1.5), 1, 0.5).empty());
}

TEST(Penetrations, of_selected_shells) {
  SheetsThatMeet sheets;
  sheets.add_plate(1);
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i - 4.3, j - 4.3, 0.6); });
  sheets.add(3, 2, 2, [](int i, int j) { return Vec3(i + 1.7, j + 1.7, 0.3); });
  const Model model = sheets.model();
  const ShellSet of_part_2{ShellIndex(std::size_t{100}), ShellIndex(std::size_t{101})}, none;
  const auto found = penetrations_of(model, given_thickness(model, 1), {0, &of_part_2});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().shells_b, of_part_2);
  EXPECT_TRUE(penetrations_of(model, given_thickness(model, 1), {0, &none}).empty());
}

TEST(Penetrations, leave_out_shells_without_thickness_area_or_coordinates) {
  const Model model = plate_below(0.5).model();
  ContactThickness thickness = given_thickness(model, 1);
  for (std::size_t s = 100; s < model.shell_count(); ++s) thickness.of_shell[s] = 0;
  EXPECT_TRUE(penetrations_of(model, thickness).empty());

  SheetsThatMeet broken = plate_below(0.5);
  const std::size_t first = broken.nodes.size() - 25;
  broken.nodes[first].position.x() = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 5; ++i) broken.nodes[first + 20 + i].position = Vec3(1, 1, 0.25);  // the last row at one place
  const auto found = penetrations_of(broken, 1);
  ASSERT_EQ(found.size(), 1u);
  for (const WayOut& way : found.front().nodes_b) EXPECT_TRUE(std::isfinite(way.depth) && way.direction.allFinite());
  EXPECT_TRUE(std::isfinite(found.front().mean_depth) && std::isfinite(found.front().area));

  SheetsThatMeet flat;
  flat.add_plate(1).add(2, 2, 2, [](int i, int) { return Vec3(i, 0.3, 0.5); });
  EXPECT_TRUE(penetrations_of(flat, 1).empty()) << "shells without area";
}

/// Two wavy sheets that come near each other in several places; on a grid of 2^-20 about `at`.
SheetsThatMeet wavy(const Vec3& at) {
  SheetsThatMeet sheets;
  const auto on_grid = [](double x) { return std::round(x * 0x1p20) * 0x1p-20; };
  for (const int sheet : {0, 1})
    sheets.add(1 + sheet, 14, 14, [=](int i, int j) {
      const double x = i + 0.3 * sheet, y = j + 0.4 * sheet;
      const double z = 1.6 * sheet + 0.5 * std::sin(x / (1 + sheet)) * std::cos(y / 3);
      return Vec3(at + Vec3(on_grid(x), on_grid(y), on_grid(z)));
    });
  return sheets;
}

void expect_same(const std::vector<Penetration>& one, const std::vector<Penetration>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t r = 0; r < one.size(); ++r) {
    EXPECT_EQ(one[r].shells_a, other[r].shells_a);
    EXPECT_EQ(one[r].shells_b, other[r].shells_b);
    EXPECT_EQ(one[r].max_depth, other[r].max_depth);
    EXPECT_EQ(one[r].mean_depth, other[r].mean_depth);
    ASSERT_EQ(one[r].pairs.size(), other[r].pairs.size());
    for (std::size_t p = 0; p < one[r].pairs.size(); ++p) {
      EXPECT_EQ(one[r].pairs[p].a, other[r].pairs[p].a);
      EXPECT_EQ(one[r].pairs[p].b, other[r].pairs[p].b);
      EXPECT_EQ(one[r].pairs[p].depth, other[r].pairs[p].depth);
    }
    ASSERT_EQ(one[r].nodes_a.size(), other[r].nodes_a.size());
  }
}

TEST(Penetrations, are_the_same_where_the_model_is_moved) {
  const auto here = penetrations_of(wavy(Vec3::Zero()), 1.3);
  EXPECT_GT(here.size(), 1u);
  for (const Vec3& at : {Vec3(4096 + 0x1p-20, -333, 0.5), Vec3(-0x1p-20, 1e5, 7e4)}) expect_same(penetrations_of(wavy(at), 1.3), here);
}

TEST(Penetrations, are_the_same_with_any_number_of_threads) {
  const auto with_threads = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return penetrations_of(wavy(Vec3::Zero()), 1.3);
  };
  expect_same(with_threads(1), with_threads(4));
}

TEST(Penetrations, are_joined_where_a_joint_is_near) {
  SheetsThatMeet sheets;
  sheets.add_plate(1);
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i - 4.3, j - 4.3, 0.6); });
  sheets.add(2, 2, 2, [](int i, int j) { return Vec3(i + 1.7, j + 1.7, 0.3); });
  const Model model = sheets.model();
  const ContactThickness thickness = given_thickness(model, 1);
  const auto found = penetrations_of(model, thickness);
  ASSERT_EQ(found.size(), 2u);
  const auto shell = [](std::size_t s) { return ShellIndex(s); };
  const auto joined = [&](std::vector<connections::JoinedSheets::Pair> joints) {
    const JointsOfParts of_parts(model, joints);
    std::vector<bool> there;
    for (const Penetration& region : found)
      there.push_back(of_parts.join_there(region.part_a, region.part_b, region.shells_a, region.shells_b, thickness));
    return there;
  };
  EXPECT_EQ(joined({}), (std::vector{false, false}));
  EXPECT_EQ(joined({{shell(88), shell(105)}}), (std::vector{true, false})) << "the deeper one is about (2.7, 2.7)";
  EXPECT_EQ(joined({{shell(101), shell(2)}}), (std::vector{false, true})) << "in either order";
  EXPECT_EQ(joined({{shell(87), shell(88)}}), (std::vector{false, false})) << "of one part";
  EXPECT_EQ(joined({{shell(88), shell(101)}}), (std::vector{false, false})) << "to a shell far away";
  EXPECT_EQ(joined({{shell(64), shell(105)}}), (std::vector{true, false})) << "within both thicknesses beside it";
  EXPECT_EQ(joined({{shell(42), shell(105)}}), (std::vector{false, false})) << "farther";
}

TEST(Penetrations, sides_change_with_the_order_of_parts_only) {
  const auto found = penetrations_of(plate_below(0.5), 1);
  SheetsThatMeet turned;
  turned.add(2, 4, 4, [](int i, int j) { return Vec3(i - 1.7, j - 1.7, 0.5); }).add_plate(1);
  const auto other = penetrations_of(turned, 1);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other.front().shells_b.size(), found.front().shells_b.size());
  EXPECT_EQ(other.front().pairs.size(), found.front().pairs.size());
  EXPECT_NEAR(other.front().worst.on_b.z(), 0.5, 1e-12);
}

}  // namespace
}  // namespace prismesh::mesh::contact
