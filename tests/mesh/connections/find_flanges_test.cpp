#include "mesh/connections/find_flanges.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::connections {
namespace {

/// Sheets of quads, each put somewhere by a function of its grid; ids go on from sheet to sheet.
struct FlangeDeck {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  using Place = std::function<Vec3(int i, int j)>;

  void add(std::int64_t part, int columns, int rows, const Place& place) {
    const auto first = static_cast<std::int64_t>(nodes.size()) + 1;
    const std::int64_t stride = columns + 1;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) nodes.push_back({first + i + j * stride, place(i, j)});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const std::int64_t corner = first + i + j * stride;
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, part, {corner, corner + 1, corner + 1 + stride, corner + stride}});
      }
  }
  Model model(double thickness) const { return test::with_thickness(test::make_model(nodes, shells), thickness); }
  Flanges find(double thickness, const FlangeOptions& options = {}) const {
    const Model made = model(thickness);
    return find_flanges(made, spatial::BoxTree(made), options);
  }
};

/// Places on a line with bends: a section, swept along x. `at` is the number of the row.
FlangeDeck::Place swept(const std::vector<Vec3>& section, double step) {
  return [section, step](int i, int j) -> Vec3 { return Vec3(step * i, 0, 0) + section[static_cast<std::size_t>(j)]; };
}

/// Two plates of which the second covers the first one's rows from y = 80 to 100 only.
FlangeDeck lapped(double scale, double gap, double length = 200) {
  FlangeDeck deck;
  const int columns = static_cast<int>(length / 5);
  deck.add(1, columns, 20, [=](int i, int j) { return Vec3(scale * 5 * i, scale * 5 * j, 0); });
  deck.add(2, columns, 20, [=](int i, int j) { return Vec3(scale * 5 * i, scale * (80 + 5 * j), scale * gap); });
  return deck;
}

TEST(FindFlanges, of_two_plates_that_lap) {
  const Flanges found = lapped(1, 1.5).find(1.5);
  ASSERT_EQ(found.all.size(), 1u);
  const Flange& flange = found.all.front();
  EXPECT_EQ(flange.sheets(), 2u);
  EXPECT_EQ(flange.parts, (std::vector<PartIndex>{PartIndex(std::size_t{0}), PartIndex(std::size_t{1})}));
  EXPECT_NEAR(flange.length, 200, 1e-9);
  EXPECT_NEAR(flange.mean_width, 20, 1e-9);
  EXPECT_NEAR(flange.min_width, 20, 1e-9);
  EXPECT_NEAR(flange.distance, 1.5, 1e-9);
  EXPECT_EQ(flange.shells.size(), 2u * 4 * 40);
  EXPECT_EQ(flange.nodes.size(), 2u * 5 * 41);
  EXPECT_FALSE(flange.closed);
  EXPECT_TRUE(found.without_thickness.empty());
  ASSERT_EQ(flange.middle.size(), flange.sides[0].size());
  ASSERT_EQ(flange.middle.size(), flange.sides[1].size());
  for (std::size_t i = 0; i < flange.middle.size(); ++i) {
    EXPECT_NEAR(flange.middle[i].y(), 90, 1e-9) << "half way between the sides";
    EXPECT_NEAR(std::abs(flange.sides[0][i].y() - flange.sides[1][i].y()), 20, 1e-9);
  }
  EXPECT_NEAR(std::abs(flange.middle.front().x() - flange.middle.back().x()), 200, 1e-9) << "from end to end";
}

TEST(FindFlanges, in_metres_and_inches_alike) {
  for (const double scale : {1e-3, 1 / 25.4}) {
    const Flanges found = lapped(scale, 1.5).find(1.5 * scale);
    ASSERT_EQ(found.all.size(), 1u) << scale;
    EXPECT_NEAR(found.all[0].length, 200 * scale, 1e-9 * scale);
    EXPECT_NEAR(found.all[0].mean_width, 20 * scale, 1e-9 * scale);
    EXPECT_NEAR(found.all[0].distance, 1.5 * scale, 1e-9 * scale);
  }
}

TEST(FindFlanges, up_to_the_distance_that_thickness_and_gap_allow) {
  EXPECT_EQ(lapped(1, 2 * 1.5 - 0.01).find(1.5).all.size(), 1u);
  EXPECT_TRUE(lapped(1, 2 * 1.5 + 0.01).find(1.5).all.empty()) << "too far";
  FlangeOptions wider;
  wider.gap = 0.02;
  EXPECT_EQ(lapped(1, 2 * 1.5 + 0.01).find(1.5, wider).all.size(), 1u);
  FlangeOptions touching;
  touching.thickness_factor = 1;
  EXPECT_EQ(lapped(1, 1.5).find(1.5, touching).all.size(), 1u) << "faces that touch";
  EXPECT_TRUE(lapped(1, 1.51).find(1.5, touching).all.empty());
}

TEST(FindFlanges, without_thickness_by_a_given_gap_only) {
  const Flanges none = lapped(1, 1.5).find(0);
  EXPECT_TRUE(none.all.empty());
  EXPECT_EQ(none.without_thickness.size(), 2u);
  FlangeOptions given;
  given.gap = 1.6;
  EXPECT_EQ(lapped(1, 1.5).find(0, given).all.size(), 1u);
}

TEST(FindFlanges, of_three_sheets) {
  FlangeDeck deck = lapped(1, 1.5);
  deck.add(3, 30, 10, [](int i, int j) { return Vec3(200.0 / 30 * i, 80 + 5.0 * j, 3.0); });
  FlangeOptions options;
  const Flanges found = deck.find(1.5, options);
  // Three sheets where all lap, two where the third lies on the second alone.
  ASSERT_EQ(found.all.size(), 2u);
  const auto three = std::find_if(found.all.begin(), found.all.end(), [](const Flange& flange) { return flange.sheets() == 3; });
  ASSERT_NE(three, found.all.end());
  EXPECT_NEAR(three->length, 200, 1e-9);
  EXPECT_NEAR(three->mean_width, 20, 1e-9);
  EXPECT_NEAR(three->distance, 1.5, 1e-9) << "of neighbours";
  EXPECT_EQ(three->parts[1], PartIndex(std::size_t{1})) << "in the order of the stack";
}

TEST(FindFlanges, two_of_a_hat_on_a_plate) {
  std::vector<Vec3> hat;
  for (int k = 0; k <= 4; ++k) hat.emplace_back(0, 5.0 * k, 1.2);
  for (int k = 1; k <= 10; ++k) hat.emplace_back(0, 20 + 0.5 * k, 1.2 + 5 * k);
  for (int k = 1; k <= 8; ++k) hat.emplace_back(0, 25 + 5.0 * k, 51.2);
  for (int k = 1; k <= 10; ++k) hat.emplace_back(0, 65 + 0.5 * k, 51.2 - 5 * k);
  for (int k = 1; k <= 4; ++k) hat.emplace_back(0, 70 + 5.0 * k, 1.2);
  FlangeDeck deck;
  deck.add(1, 60, static_cast<int>(hat.size()) - 1, swept(hat, 5));
  deck.add(2, 43, 17, [](int i, int j) { return Vec3(-11 + 7.3 * i, -14 + 7.1 * j, 0); });  // lines of its mesh go anywhere
  const Flanges found = deck.find(1.2);
  ASSERT_EQ(found.all.size(), 2u);
  for (const Flange& flange : found.all) {
    EXPECT_NEAR(flange.length, 300, 1e-9) << "the hat's border is clear";
    EXPECT_NEAR(flange.mean_width, 20, 1e-9);
    EXPECT_NEAR(flange.distance, 1.2, 1e-9);
    EXPECT_TRUE(std::abs(flange.centre().y() - 10) < 1e-9 || std::abs(flange.centre().y() - 80) < 1e-9);
  }
  EXPECT_NE(found.all[0].centre().y(), found.all[1].centre().y());
}

/// An arc of the sheet's middle from radius 300 to 320, bent in its own plane.
FlangeDeck::Place arc(double degrees, int columns, int rows, double z) {
  return [=](int i, int j) {
    const double angle = degrees * std::numbers::pi / 180 * i / columns, radius = 300 + 20.0 * j / rows;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
}

TEST(FindFlanges, that_are_curved) {
  FlangeDeck deck;
  deck.add(1, 120, 4, arc(120, 120, 4, 0));
  deck.add(2, 97, 3, arc(120, 97, 3, 1));
  const Flanges found = deck.find(1);
  ASSERT_EQ(found.all.size(), 1u);
  const double length = 310 * 120 * std::numbers::pi / 180;
  EXPECT_NEAR(found.all[0].length, length, 0.002 * length);
  EXPECT_NEAR(found.all[0].mean_width, 20, 0.05);
  EXPECT_NEAR(found.all[0].min_width, 20, 0.1);
  for (const Vec3& point : found.all[0].middle) EXPECT_NEAR(point.norm(), 310, 0.6);
}

TEST(FindFlanges, that_close_in_a_ring) {
  FlangeDeck deck;
  deck.add(1, 180, 4, arc(360, 180, 4, 0));
  deck.add(2, 180, 4, arc(360, 180, 4, 1));
  for (test::ShellSpec& shell : deck.shells)  // the last column's nodes are those of the first
    for (std::int64_t& node : shell.nodes)
      if ((node - 1) % 181 == 180) node -= 180;
  const Flanges found = deck.find(1);
  ASSERT_EQ(found.all.size(), 1u);
  EXPECT_TRUE(found.all[0].closed);
  EXPECT_NEAR(found.all[0].length, 2 * std::numbers::pi * 310, 2);
  EXPECT_NEAR(found.all[0].mean_width, 20, 0.1);
  EXPECT_NEAR((found.all[0].middle.front() - found.all[0].middle.back()).norm(), 0, 1e-9);
}

TEST(FindFlanges, of_folds_of_one_part) {
  // A hem: a plate whose last 15 are folded back over itself, at 1 from it.
  std::vector<Vec3> hem;
  for (int k = 0; k <= 20; ++k) hem.emplace_back(0, 5.0 * k, 0);
  hem.emplace_back(0, 100.5, 0.5);
  for (int k = 0; k <= 3; ++k) hem.emplace_back(0, 100 - 5.0 * k, 1);
  FlangeDeck deck;
  deck.add(1, 40, static_cast<int>(hem.size()) - 1, swept(hem, 5));
  const Flanges found = deck.find(1);
  ASSERT_EQ(found.all.size(), 1u);
  EXPECT_EQ(found.all[0].sheets(), 2u);
  EXPECT_EQ(found.all[0].parts[0], found.all[0].parts[1]);
  EXPECT_NEAR(found.all[0].mean_width, 15, 1e-9);
  EXPECT_NEAR(found.all[0].length, 200, 1e-9);
}

TEST(FindFlanges, whatever_the_shells_orientation) {
  FlangeDeck deck = lapped(1, 1.5);
  for (test::ShellSpec& shell : deck.shells)
    if (shell.id % 3 == 0 || shell.id > 1100) std::swap(shell.nodes[1], shell.nodes[3]);
  const Flanges found = deck.find(1.5);
  ASSERT_EQ(found.all.size(), 1u);
  EXPECT_EQ(found.all[0].shells.size(), 2u * 4 * 40);
}

TEST(FindFlanges, none_where_plates_cross) {
  for (const double degrees : {90.0, 45.0, 5.0}) {
    FlangeDeck deck;
    const double slope = degrees * std::numbers::pi / 180;
    deck.add(1, 40, 20, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
    deck.add(2, 40, 20, [=](int i, int j) {
      const double across = 5.0 * j - 49;
      return Vec3(5.0 * i, 49 + across * std::cos(slope), across * std::sin(slope));
    });
    EXPECT_TRUE(deck.find(1.5).all.empty()) << degrees;
  }
}

TEST(FindFlanges, none_of_a_plate_on_a_plate_or_a_short_lap) {
  FlangeDeck whole;
  for (const int sheet : {0, 1}) whole.add(1 + sheet, 40, 20, [=](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 1.5 * sheet); });
  EXPECT_TRUE(whole.find(1.5).all.empty()) << "100 wide, more than 40 thicknesses";
  FlangeOptions wide;
  wide.max_width = 101;
  EXPECT_EQ(whole.find(1.5, wide).all.size(), 1u);
  EXPECT_TRUE(lapped(1, 1.5, 25).find(1.5).all.empty()) << "25 long, 20 wide: the foot of a bracket";
  EXPECT_EQ(lapped(1, 1.5, 35).find(1.5).all.size(), 1u);
}

TEST(FindFlanges, none_of_two_shells_or_of_shells_on_the_same_nodes) {
  for (const int columns : {2, 4}) {
    FlangeDeck deck;
    for (const int sheet : {0, 1}) deck.add(1 + sheet, columns, 1, [=](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 1.5 * sheet); });
    EXPECT_EQ(deck.find(1.5).all.size(), columns == 2 ? 0u : 1u);
  }
  FlangeDeck doubled;
  doubled.add(1, 40, 4, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  for (std::int64_t id = 1; id <= 160; ++id) {
    test::ShellSpec again = doubled.shells[static_cast<std::size_t>(id - 1)];
    again.id += 160, again.part = 2;
    doubled.shells.push_back(again);
  }
  EXPECT_TRUE(doubled.find(1.5).all.empty());
  FlangeDeck coincident = lapped(1, 0);
  ASSERT_EQ(coincident.find(1.5).all.size(), 1u) << "nodes of their own at the same place";
  EXPECT_NEAR(coincident.find(1.5).all[0].mean_width, 20, 1e-9);
}

TEST(FindFlanges, none_with_a_hidden_part_or_when_stopped) {
  const std::vector<std::uint8_t> second_hidden{0, 1};
  FlangeOptions options;
  options.out_of_sight = second_hidden;
  EXPECT_TRUE(lapped(1, 1.5).find(1.5, options).all.empty());
  const Model model = lapped(1, 1.5).model(1.5);
  EXPECT_TRUE(find_flanges(model, spatial::BoxTree(model), {}, [](double) { return false; }).all.empty()) << "stopped";
}

TEST(FindFlanges, narrow_places_are_the_smallest_width) {
  FlangeDeck deck;
  deck.add(1, 40, 20, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  // Its edge goes from 20 to 10 in the middle and back.
  deck.add(2, 40, 4, [](int i, int j) { return Vec3(5.0 * i, 50 + (10 + std::abs(i - 20) / 2.0) * j / 4, 1.5); });
  const Flanges found = deck.find(1.5);
  ASSERT_EQ(found.all.size(), 1u);
  EXPECT_NEAR(found.all[0].min_width, 10, 0.15);
  EXPECT_NEAR(found.all[0].mean_width, 15, 0.3);
}

}  // namespace
}  // namespace prismesh::mesh::connections
