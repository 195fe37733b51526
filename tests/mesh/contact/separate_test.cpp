#include "mesh/contact/separate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/lift_apart.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/report.h"
#include "tests/mesh/contact/plain_clearance.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

using test::perforations_of;
using test::PlainClearance;
using test::SheetsThatMeet;
using testing::HasSubstr;

constexpr double kRadian = 3.14159265358979323846 / 180;
constexpr double kSize = 1;  ///< of the shells, and the target size

/// What was separated, and what became of the model.
struct Separated {
  Model before, after;
  ContactThickness thickness;
  Separation done;
  quality::Counts counts_before, counts_after;

  std::string why() const { return done.left.empty() ? "" : done.left.front().why; }
  double clearance(std::size_t a = 0, std::size_t b = 1) const { return PlainClearance::between(after, PartIndex(a), PartIndex(b)); }
};

std::string_view goes(NodeIndex) { return {}; }

Separated separate_in(const Model& model, ContactThickness thickness, const SeparationWish& wish = {},
                      const std::function<std::string_view(NodeIndex)>& why_stays = goes,
                      const std::vector<connections::JoinedSheets::Pair>& joints = {}) {
  const spatial::BoxTree tree(model);
  const quality::SizedCriteria criteria{quality::default_criteria(), kSize};
  ChunkedArray<quality::ShellState> states = quality::judge_model(model, criteria);
  Separated result{model, model, std::move(thickness), {}, quality::count(states), {}};
  const auto done = separate({model, tree, result.thickness, criteria, states, joints, why_stays}, wish);
  if (!done) ADD_FAILURE() << done.error().text();
  result.done = done.value_or(Separation{});
  for (std::size_t i = 0; i < result.done.nodes.size(); ++i)
    result.after.positions.set(result.done.nodes[i].value, result.done.positions[i]);
  result.counts_after = quality::count(quality::judge_model(result.after, criteria));
  return result;
}
Separated separate_in(const SheetsThatMeet& sheets, double thickness, const SeparationWish& wish = {},
                      const std::function<std::string_view(NodeIndex)>& why_stays = goes) {
  const Model model = sheets.model();
  return separate_in(model, given_thickness(model, thickness), wish, why_stays);
}

/// All regions are gone, by code that shares none with separating, and nothing else suffered.
void expect_clear(const Separated& result, double least, double max_move, const std::string& what = "") {
  SCOPED_TRACE(what);
  EXPECT_TRUE(result.done.left.empty()) << result.why();
  EXPECT_GT(result.done.regions_before, 0u);
  EXPECT_GE(result.clearance(), least * (1 - 0.01));
  EXPECT_LE(result.counts_after.fail, result.counts_before.fail);
  EXPECT_LE(result.done.largest_move, max_move + 0.05 * kSize);
  const spatial::BoxTree tree(result.after);
  const auto crossings = find_shell_crossings(result.after, tree);
  EXPECT_TRUE(crossings.empty());
  EXPECT_TRUE(find_penetrations(result.after, tree, result.thickness, crossings).empty());
}

void expect_left(const Separated& result, const std::string& why) {
  EXPECT_EQ(result.done.left.size(), result.done.regions_before);
  EXPECT_EQ(result.done.regions_before, 1u);
  EXPECT_THAT(result.why(), HasSubstr(why));
  EXPECT_TRUE(result.done.nodes.empty());
  EXPECT_EQ(result.done.depth_after, result.done.depth_before);
  EXPECT_EQ(result.done.largest_move, 0);
}

/// A plate of 10 x 10 shells of size 1 about the origin, and one of 4 x 4 above it, off its nodes.
SheetsThatMeet close_plates(double height) {
  SheetsThatMeet sheets;
  return sheets.add(1, 10, 10, [](int i, int j) { return Vec3(i - 5, j - 5, 0); }).add(2, 4, 4, [=](int i, int j) {
    return Vec3(i - 1.7, j - 1.7, height);
  });
}

/// The same with the smaller plate inclined, so that its edge goes through by `depth`.
SheetsThatMeet piercing_plate(double degrees, double depth) {
  SheetsThatMeet sheets;
  const double angle = degrees * kRadian;
  return sheets.add(1, 18, 12, [](int i, int j) { return Vec3(i - 6, j - 6, 0); }).add(2, 12, 5, [=](int i, int j) {
    return Vec3(i * std::cos(angle) - 2.3, j - 2.7, i * std::sin(angle) - depth);
  });
}

std::function<std::string_view(NodeIndex)> locked(const Model& model, std::size_t part) {
  NodeSet nodes;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (model.shell_parts[s] == PartIndex(part))
      for (const NodeIndex node : model.shell_nodes[s].node) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  return [nodes](NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node) ? "are locked" : std::string_view(); };
}

TEST(LiftApart, of_parallel_and_inclined_triangles) {
  const Triangle flat{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto at = [](double x, double y, double z) { return Triangle{Vec3(x, y, z), Vec3(x + 1, y, z), Vec3(x, y + 1, z)}; };
  EXPECT_NEAR(lift_apart(at(1, 1, -3), flat, Vec3::UnitZ(), 0.5), 3.5, 1e-9);
  EXPECT_NEAR(lift_apart(at(1, 1, 0.2), flat, Vec3::UnitZ(), 0.5), 0.3, 1e-9);
  EXPECT_EQ(lift_apart(at(1, 1, 0.6), flat, Vec3::UnitZ(), 0.5), 0) << "it is clear";
  EXPECT_EQ(lift_apart(at(7, 7, -3), flat, Vec3::UnitZ(), 0.5), 0) << "it passes beside the other one";
  EXPECT_NEAR(lift_apart(at(1, 1, 0), flat, Vec3(0.6, 0, 0.8), 0.5), 0.5 / 0.8, 1e-9) << "along an oblique direction";
  EXPECT_NEAR(lift_apart(at(-1.3, 1, -2), flat, Vec3::UnitZ(), 0.5), 2.4, 1e-9) << "its corner passes the other's side at 0.3: 0.4 above";
}

TEST(LiftApart, where_corners_stay) {
  const Triangle flat{Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 9, 0)};
  const Triangle steep{Vec3(-1, 0, -1), Vec3(1, 0, 1), Vec3(1, 1, 1)};
  EXPECT_NEAR(lift_corners_apart(steep, {true, false, false}, flat, Vec3::UnitZ(), 0.5).value_or(-1), 1.5, 1e-6);
  EXPECT_NEAR(lift_corners_apart(steep, {true, true, false}, flat, Vec3::UnitZ(), 0.5).value_or(-1), 1.5, 1e-6);
  EXPECT_FALSE(lift_corners_apart(steep, {false, true, true}, flat, Vec3::UnitZ(), 0.5)) << "the corner that stays is below";
  EXPECT_FALSE(lift_corners_apart(steep, {false, false, false}, flat, Vec3::UnitZ(), 0.5));
  EXPECT_EQ(lift_corners_apart(steep, {false, false, false}, {flat[0], flat[1], Vec3(0, -9, -5)}, Vec3::UnitZ(), 0.5).value_or(-1), 0)
      << "it is clear";
  const Triangle post{Vec3(-0.1, 0, -9), Vec3(0.1, 0.1, -9), Vec3(0, 0, 0.6)};
  const Triangle over{Vec3(-2, 0.01, 0), Vec3(2, 0.01, 0), Vec3(2, 0.02, 0)};
  EXPECT_NEAR(lift_corners_apart(over, {false, true, true}, post, Vec3::UnitZ(), 0.1).value_or(-1), 1.4, 0.02)
      << "halfway between a corner that stays and those that go";
}

TEST(LiftApart, where_corners_stay_is_enough_and_not_more_than_that) {
  std::mt19937 random(5);
  const auto place = [&](double z) {
    const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
    const double x = uniform(), y = uniform();
    return Vec3(2 * x, 2 * y, z + 0.4 * uniform());
  };
  int lifted = 0;
  for (int i = 0; i < 300; ++i) {
    const Triangle moving{place(0), place(0), place(1)}, fixed{place(0), place(0), place(0)};
    const auto lift = lift_corners_apart(moving, {true, true, false}, fixed, Vec3::UnitZ(), 0.2);
    if (!lift || *lift == 0) continue;
    ++lifted;
    const auto misses = [&](double share) {
      const Vec3 by = share * *lift * Vec3::UnitZ();
      return lift_apart({moving[0] + by, moving[1] + by, moving[2]}, fixed, Vec3::UnitZ(), 0.2);
    };
    EXPECT_LE(misses(1), 1e-7);
    EXPECT_LE(misses(1.5), 1e-7) << "further on, too";
    EXPECT_GT(misses(0.999), 1e-7);
  }
  EXPECT_GT(lifted, 60);
}

TEST(Separate, moves_both_of_two_close_plates_by_half) {
  for (const double height : {0.9, -0.4}) {
    const Separated result = separate_in(close_plates(height), 1);
    expect_clear(result, 1, (1 - std::abs(height)) / 2);
    EXPECT_NEAR(result.done.depth_before, 1 - std::abs(height), 1e-9);
    EXPECT_EQ(result.done.depth_after, 0);
  }
}

TEST(Separate, moves_one_plate_where_the_other_is_locked_or_not_to_move) {
  const Model model = close_plates(0.5).model();
  for (const std::size_t part : {0, 1}) {
    const Separated result = separate_in(model, given_thickness(model, 1), {}, locked(model, part));
    expect_clear(result, 1, 0.5);
    for (const NodeIndex node : result.done.nodes)
      EXPECT_EQ(model.shell_parts[model.adjacency->shells_of(node).front().value], PartIndex(1 - part));
  }
  ShellSet of_second;
  for (std::size_t s = 100; s < model.shell_count(); ++s) of_second.push_back(ShellIndex(s));
  for (const MovingSide side : {MovingSide::on, MovingSide::against}) {
    SeparationWish wish;
    wish.on = &of_second, wish.move = side;
    const Separated result = separate_in(model, given_thickness(model, 1), wish);
    expect_clear(result, 1, 0.5);
    const std::size_t moves = side == MovingSide::on ? 1 : 0;
    for (const NodeIndex node : result.done.nodes)
      EXPECT_EQ(model.shell_parts[model.adjacency->shells_of(node).front().value], PartIndex(moves));
  }
}

TEST(Separate, leaves_the_gap_and_goes_along_the_direction) {
  SeparationWish wish;
  wish.gap = 0.25;
  expect_clear(separate_in(close_plates(0.5), 1, wish), 1.25, 0.375);
  wish.gap = 0;
  wish.direction = Vec3(0.6, 0, -0.8);
  wish.move = MovingSide::both;
  const Separated result = separate_in(close_plates(0.5), 1, wish);
  expect_clear(result, 1, 0.25 / 0.8);
  for (std::size_t i = 0; i < result.done.nodes.size(); ++i) {
    const Vec3 move = result.done.positions[i] - result.before.position(result.done.nodes[i]);
    EXPECT_NEAR(move.cross(*wish.direction).norm(), 0, 1e-12);
  }
  wish.direction = Vec3(1, 0, 0.05);
  expect_left(separate_in(close_plates(0.5), 1, wish), "the direction runs along the shells");
}

TEST(Separate, pushes_a_plate_out_that_pierces_another) {
  for (const double degrees : {5.0, 30.0, 60.0}) {
    const double depth = degrees < 15 ? 0.45 : 1.3;
    const Separated result = separate_in(piercing_plate(degrees, depth), 0.8);
    expect_clear(result, 0.8, depth + 0.8, "at " + std::to_string(degrees) + " degrees");
    EXPECT_NEAR(result.done.depth_before, depth, 1e-9);
    EXPECT_EQ(result.done.depth_after, 0);
  }
}

TEST(Separate, pushes_the_pierced_plate_away_where_the_other_is_locked) {
  const Model model = piercing_plate(20, 1).model();
  const Separated result = separate_in(model, given_thickness(model, 0.8), {}, locked(model, 1));
  expect_clear(result, 0.8, 1.8);
}

/// A plate, and above it one with a square bump, of `half` shells to each side, that goes through it by `depth`; its flanks are at 60
/// degrees.
SheetsThatMeet bump_through_plate(double depth, int half, int rings_about) {
  constexpr double kAbove = 2, kFlank = 1.7320508075688772;
  const int count = 2 * (half + rings_about);
  SheetsThatMeet sheets;
  sheets.add(1, 24, 24, [](int i, int j) { return Vec3(i - 12.3, j - 12.4, 0); });
  return sheets.add(2, count, count, [=](int i, int j) {
    const double x = i - count / 2, y = j - count / 2;
    return Vec3(x, y, std::clamp(kAbove - kFlank * (half - std::max(std::abs(x), std::abs(y))), -depth, kAbove));
  });
}

TEST(Separate, pushes_a_bump_back_through_a_flat_sheet) {
  for (const auto& [half, rings] : {std::pair(4, 8), std::pair(8, 0)}) {  // in the last case the bump has most of the nodes
    const Separated result = separate_in(bump_through_plate(0.4, half, rings), 0.5);
    expect_clear(result, 0.5, 0.4 + 0.5, std::to_string(rings) + " rings about the bump");
    for (const NodeIndex node : result.done.nodes)
      EXPECT_EQ(result.before.shell_parts[result.before.adjacency->shells_of(node).front().value], PartIndex(std::size_t{1}));
  }
}

TEST(Separate, leaves_a_bump_whose_sheets_are_locked) {
  const Model model = bump_through_plate(0.4, 4, 8).model();
  expect_left(separate_in(model, given_thickness(model, 0.5), {}, [](NodeIndex) { return std::string_view("are locked"); }), "are locked");
}

/// The nodes of the second sheet of `piercing_plate` in this column from its edge.
std::function<std::string_view(NodeIndex)> welded_column(std::function<std::string_view(NodeIndex)> others, std::size_t column) {
  constexpr std::size_t kFirst = 19 * 13, kStride = 13;
  return [others = std::move(others), column](NodeIndex node) {
    return node.value >= kFirst && (node.value - kFirst) % kStride == column ? "carry welds or ties" : others(node);
  };
}

TEST(Separate, goes_on_beside_nodes_that_stay_and_need_not_move) {
  const Model model = piercing_plate(20, 1).model();
  const Separated result = separate_in(model, given_thickness(model, 0.8), {}, welded_column(locked(model, 0), 6));
  expect_clear(result, 0.8, 1.8);
  for (const NodeIndex node : result.done.nodes) EXPECT_NE((node.value - 19 * 13) % 13, 6u);
  expect_left(separate_in(model, given_thickness(model, 0.8), {}, welded_column(locked(model, 0), 2)), "carry welds or ties");
}

TEST(Separate, moves_the_other_side_where_welds_hold_the_one_that_enters) {
  const Model model = piercing_plate(20, 1).model();
  const Separated result = separate_in(model, given_thickness(model, 0.8), {}, welded_column(goes, 2));
  expect_clear(result, 0.8, 1.8);
  for (const NodeIndex node : result.done.nodes) EXPECT_LT(node.value, 19u * 13u);
}

/// A spherical cap whose lowest point is at `depth` below a plate.
SheetsThatMeet pressed_sphere(double depth, double radius) {
  SheetsThatMeet sheets;
  return sheets.add(1, 18, 18, [](int i, int j) { return Vec3(i - 9, j - 9, 0); }).add(2, 13, 13, [=](int i, int j) {
    const double x = i - 6.3, y = j - 6.4;
    return Vec3(x, y, radius - depth - std::sqrt(radius * radius - x * x - y * y));
  });
}

TEST(Separate, pushes_a_sphere_out_of_a_plate) {
  for (const double depth : {0.6}) expect_clear(separate_in(pressed_sphere(depth, 20), 0.3), 0.3, depth + 0.3);
  expect_clear(separate_in(pressed_sphere(-0.2, 20), 0.3), 0.3, 0.05, "too close only");
}

/// One strip that is folded back over itself, with a dent in the upper fold that goes `depth` through the lower one.
SheetsThatMeet dented_fold(double depth) {
  constexpr double kRadius = 2, kStraight = 16;
  SheetsThatMeet sheets;
  return sheets.add(1, 38, 16, [=](int i, int j) {
    const double along = i, bend = kRadius * 3.14159265358979323846;
    if (along <= kStraight) return Vec3(along + 0.3, j, 0);
    if (along < kStraight + bend) {
      const double angle = (along - kStraight) / kRadius;
      return Vec3(kStraight + 0.3 + kRadius * std::sin(angle), j, kRadius * (1 - std::cos(angle)));
    }
    const double x = 2 * kStraight + bend - along, r = std::hypot(x - 5.7, j - 8);
    return Vec3(x + 0.3, j, 2 * kRadius - (2 * kRadius + depth) * std::exp(-r * r / 5));
  });
}

TEST(Separate, moves_two_folds_of_one_part_apart) {
  const double depth = 0.3;
  const Model model = dented_fold(depth).model();
  ASSERT_EQ(perforations_of(model).size(), 1u);
  const Separated result = separate_in(model, given_thickness(model, 0.4));
  EXPECT_TRUE(result.done.left.empty()) << result.why();
  EXPECT_EQ(result.done.regions_before, 1u);
  EXPECT_LE(result.done.largest_move, depth + 0.4 + 0.05 * kSize);
  EXPECT_LE(result.counts_after.fail, result.counts_before.fail);
  const spatial::BoxTree tree(result.after);
  const auto crossings = find_shell_crossings(result.after, tree);
  EXPECT_TRUE(crossings.empty());
  EXPECT_TRUE(find_penetrations(result.after, tree, result.thickness, crossings).empty());
}

TEST(Separate, moves_nested_cylinders_apart_all_around) {
  SheetsThatMeet sheets;
  const auto tube = [](double radius, double shift) {
    return [=](int i, int j) {
      const double angle = (4.5 * i + shift) * kRadian;
      return Vec3(radius * std::cos(angle), radius * std::sin(angle), j);
    };
  };
  sheets.add(1, 60, 1, tube(13, 0)).add(2, 60, 1, tube(13.6, 2));
  const Separated result = separate_in(sheets, 0.8);
  expect_clear(result, 0.8, 0.2);
}

TEST(Separate, leaves_what_is_half_through) {
  SheetsThatMeet sheets;
  sheets.add(1, 10, 10, [](int i, int j) { return Vec3(i, j, 0); }).add(2, 10, 10, [](int i, int j) {
    return Vec3(i + 5.5, 4.6, j - 4.7);
  });
  expect_left(separate_in(sheets, 0.5), "half through: nothing is cut off");
}

TEST(Separate, leaves_joined_parts_unless_asked) {
  const Model model = close_plates(0.5).model();
  const std::vector<connections::JoinedSheets::Pair> joints{{ShellIndex(45), ShellIndex(105)}};
  expect_left(separate_in(model, given_thickness(model, 1), {}, goes, joints), "the parts are joined there");
  SeparationWish wish;
  wish.joined = true;
  expect_clear(separate_in(model, given_thickness(model, 1), wish, goes, joints), 1, 0.25);
}

TEST(Separate, leaves_what_is_locked) {
  expect_left(separate_in(close_plates(0.5), 1, {}, [](NodeIndex) { return std::string_view("are locked"); }),
              "nodes of part 1 are locked");
  const Model model = piercing_plate(20, 1).model();
  expect_left(separate_in(model, given_thickness(model, 0.8), {}, [](NodeIndex) { return std::string_view("are locked"); }),
              "nodes of part 2 are locked");
}

TEST(Separate, leaves_what_needs_more_than_max_move) {
  SeparationWish wish;
  wish.max_move = 0.2;
  expect_left(separate_in(close_plates(0.5), 1, wish), "max_move is too small: it takes 0.25");
  wish.max_move = 0.3;
  expect_clear(separate_in(close_plates(0.5), 1, wish), 1, 0.25);
}

TEST(Separate, leaves_depths_that_are_allowed) {
  SeparationWish wish;
  wish.allowed_depth = 0.6;
  expect_left(separate_in(close_plates(0.5), 1, wish), "no deeper than allowed_depth");
  wish.allowed_depth = 0.2;
  const Separated result = separate_in(close_plates(0.5), 1, wish);
  EXPECT_TRUE(result.done.left.empty()) << result.why();
  EXPECT_NEAR(result.clearance(), 0.8, 1e-6);
  EXPECT_NEAR(result.done.depth_after, 0.2, 1e-6);
}

TEST(Separate, leaves_parts_without_thickness_unless_a_gap_is_given) {
  const Model model = piercing_plate(20, 1).model();
  const ContactThickness none = section_thickness(model);
  expect_left(separate_in(model, none), "no thickness: say which gap");
  SeparationWish wish;
  wish.gap = 0.5;
  const Separated result = separate_in(model, none, wish);
  EXPECT_TRUE(result.done.left.empty()) << result.why();
  EXPECT_GE(result.clearance(), 0.5 * 0.99);
}

TEST(Separate, leaves_what_would_be_pushed_into_a_third_part) {
  SheetsThatMeet sheets = close_plates(0.5);
  sheets.add(3, 4, 4, [](int i, int j) { return Vec3(i - 1.7, j - 1.7, 1.55); });
  sheets.add(4, 4, 4, [](int i, int j) { return Vec3(i - 1.7, j - 1.7, -1.05); });
  expect_left(separate_in(sheets, 1), "it would push part");
}

TEST(Separate, leaves_regions_of_other_parts_and_places) {
  SheetsThatMeet sheets = close_plates(0.5);
  sheets.add(3, 5, 5, [](int i, int j) { return Vec3(i + 100, j, 0); }).add(4, 5, 5, [](int i, int j) { return Vec3(i + 100.3, j, 0.7); });
  const Model model = sheets.model();
  EXPECT_EQ(separate_in(model, given_thickness(model, 1)).done.regions_before, 2u);
  SeparationWish wish;
  wish.at = Vec3(103, 3, 0);
  const Separated at = separate_in(model, given_thickness(model, 1), wish);
  EXPECT_EQ(at.done.regions_before, 1u);
  EXPECT_NEAR(at.done.depth_before, 0.3, 1e-9);
  EXPECT_EQ(at.done.depth_after, 0);
  EXPECT_GE(at.clearance(2, 3), 0.99);
  EXPECT_EQ(at.clearance(0, 1), 0.5);
  ShellSet none;
  wish = {};
  wish.against = &none;
  EXPECT_EQ(separate_in(model, given_thickness(model, 1), wish).done.regions_before, 0u);
  wish = {};
  wish.penetrations = false;
  EXPECT_EQ(separate_in(model, given_thickness(model, 1), wish).done.regions_before, 0u);
}

TEST(Separate, can_be_cancelled) {
  const Model model = close_plates(0.5).model();
  const spatial::BoxTree tree(model);
  const ContactThickness thickness = given_thickness(model, 1);
  const quality::SizedCriteria criteria{quality::default_criteria(), kSize};
  const auto states = quality::judge_model(model, criteria);
  const auto done = separate({model, tree, thickness, criteria, states, {}, goes}, {}, [](double) { return false; });
  ASSERT_FALSE(done);
  EXPECT_TRUE(is_cancelled(done.error()));
}

/// A curved sheet and a smaller one that is planted into it, in any position.
struct Planted {
  SheetsThatMeet sheets;
  double depth = 0;
  double thickness = 0;
};
Planted plant(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
  const double bend_x = uniform(-0.012, 0.012), bend_y = uniform(-0.012, 0.012), tilt = uniform(0, 35) * kRadian,
               turn = uniform(0, 360) * kRadian;
  Planted planted;
  planted.thickness = uniform(0.25, 0.6);
  planted.depth = uniform(-0.6 * planted.thickness, 1.3);  // below 0: too close only
  const Vec3 shift(uniform(-500, 500), uniform(-500, 500), uniform(-500, 500));
  const Vec3 axis = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
  const Eigen::AngleAxisd turned(uniform(0, 360) * kRadian, axis);
  const double off_x = uniform(0, 1), off_y = uniform(0, 1);
  const auto height = [=](double x, double y) { return bend_x * x * x + bend_y * y * y; };
  const Eigen::AngleAxisd tilted(tilt, Vec3(std::cos(turn), std::sin(turn), 0));
  double lowest = 1e9;
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; j <= 5; ++j) {
      const Vec3 at = tilted * Vec3(i - 2.5, j - 2.5, 0);
      lowest = std::min(lowest, at.z() - height(at.x() + off_x, at.y() + off_y));
    }
  const double depth = planted.depth;
  planted.sheets.add(1, 13, 13, [=](int i, int j) { return Vec3(turned * Vec3(i - 6, j - 6, height(i - 6, j - 6)) + shift); });
  planted.sheets.add(2, 5, 5, [=](int i, int j) {
    const Vec3 at = tilted * Vec3(i - 2.5, j - 2.5, 0);
    return Vec3(turned * Vec3(at.x() + off_x, at.y() + off_y, at.z() - lowest - depth) + shift);
  });
  return planted;
}

TEST(Separate, clears_what_is_planted_at_random) {
  int count = 0;
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Planted planted = plant(seed);
    const Separated result = separate_in(planted.sheets, planted.thickness);
    if (result.done.regions_before == 0) continue;  // less deep than counts
    ++count;
    expect_clear(
        result, planted.thickness, planted.depth + planted.thickness,
        "seed " + std::to_string(seed) + ", depth " + std::to_string(planted.depth) + ", thickness " + std::to_string(planted.thickness));
  }
  EXPECT_GE(count, 25);
}

TEST(Separate, gives_the_same_bits_with_any_number_of_threads) {
  for (const std::uint32_t seed : {3u, 8u}) {
    const Planted planted = plant(seed);
    std::vector<Separated> results;
    for (const std::size_t threads : {1, 2, 7}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      results.push_back(separate_in(planted.sheets, planted.thickness));
    }
    for (const Separated& other : results) {
      EXPECT_EQ(other.done.nodes, results.front().done.nodes);
      EXPECT_EQ(other.done.positions, results.front().done.positions);
      EXPECT_EQ(other.done.depth_before, results.front().done.depth_before);
    }
    EXPECT_FALSE(results.front().done.nodes.empty());
  }
}

}  // namespace
}  // namespace prismesh::mesh::contact
