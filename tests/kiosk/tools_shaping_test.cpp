// Edits from mouse and keyboard input; axes; entries that stay after a restart.
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "kiosk/input/key_table.h"
#include "kiosk/input/typed_numbers.h"
#include "kiosk/toolkit/history_file.h"
#include "kiosk/tools/parts/file_expression.h"
#include "kiosk/tools/shaping/axis_pick.h"
#include "kiosk/tools/shaping/falloff_direction.h"
#include "kiosk/tools/shaping/falloff_ring.h"
#include "kiosk/tools/shaping/shaping_options.h"
#include "kiosk/tools/shaping/typed_number.h"
#include "mesh/document/edit_kinds.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using input::Under;
using toolkit::HistoryFile;

using mesh::Vec3;
namespace document = mesh::document;

TEST(FalloffRing, lies_where_the_profile_is_a_half) {
  using mesh::shape::Profile;
  EXPECT_NEAR(halfway_share({Profile::linear, 0, {}}), 0.5, 1e-12);
  EXPECT_NEAR(halfway_share({Profile::sharp, 0, {}}), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(halfway_share({Profile::linear, 0.4, {}}), 0.3, 1e-12) << "of the way that is left beside the flat top";
  EXPECT_EQ(halfway_share({Profile::constant, 0, {}}), 0) << "it never falls";
}

TEST(FalloffRing, a_drag_brings_the_line_under_the_pointer) {
  using mesh::shape::Profile;
  // The border is 100 pixels from the foot: the line of a linear falloff is taken at 50.
  const input::Pixel foot(300, 200);
  RingDrag drag({Profile::linear, 0, {}}, foot, foot + input::Pixel(50, 0));
  EXPECT_EQ(drag.flat_at(foot + input::Pixel(50, 0)), 0);
  EXPECT_NEAR(drag.flat_at(foot + input::Pixel(0, 75)), 0.5, 1e-12) << "in any direction";
  EXPECT_EQ(drag.flat_at(foot + input::Pixel(20, 0)), 0) << "no flat top is as small as it gets";
  EXPECT_EQ(drag.flat_at(foot + input::Pixel(500, 0)), RingDrag::kFlattest) << "beyond the border";
  // Where it is let go, it is taken again.
  RingDrag again({Profile::linear, 0.5, {}}, foot, foot + input::Pixel(75, 0));
  EXPECT_NEAR(again.flat_at(foot + input::Pixel(75, 0)), 0.5, 1e-12);
  EXPECT_NEAR(again.flat_at(foot + input::Pixel(50, 0)), 0, 1e-12);
  RingDrag of_none({Profile::constant, 0, {}}, foot, foot);
  EXPECT_EQ(of_none.flat_at(foot + input::Pixel(50, 0)), 0) << "finite where there is no line";
}

TEST(ShapingOptionsTest, every_option_stands_in_the_edit) {
  ShapingOptions options;
  options.profile = mesh::shape::Profile::gaussian;
  options.flat = 0.3;
  options.along = falloff_along(DeckAxis::y);
  options.free_ends = mesh::shape::FreeEnds::held;
  options.origin = mesh::shape::Origin::free_edge;
  options.across_welds = true;
  options.each_normal = true;
  options.max_move = 4;
  options.symmetry = DeckAxis::x;
  const document::Edit edit = edit_of({Under::lift_handle, 17, Vec3(5, 6, 7)}, options, Pull{Vec3::Zero(), 2.5, 0});
  const auto& lift = std::get<document::Lift>(edit);
  EXPECT_EQ(lift.distance, 2.5);
  EXPECT_TRUE(lift.each_normal);
  EXPECT_EQ(std::get<std::int64_t>(*lift.shaping.grab), 17);
  EXPECT_EQ(lift.shaping.weights.falloff.profile, mesh::shape::Profile::gaussian);
  EXPECT_EQ(lift.shaping.weights.falloff.flat, 0.3);
  EXPECT_EQ(*lift.shaping.weights.falloff.along, Vec3(0, 1, 0));
  EXPECT_EQ(lift.shaping.weights.free_ends, mesh::shape::FreeEnds::held);
  EXPECT_EQ(lift.shaping.weights.origin, mesh::shape::Origin::free_edge);
  EXPECT_TRUE(lift.shaping.weights.across_welds);
  EXPECT_EQ(*lift.shaping.max_move, 4);
  EXPECT_EQ(lift.shaping.symmetry->normal, Vec3(1, 0, 0));
  EXPECT_EQ(lift.shaping.symmetry->point, Vec3(5, 0, 0)) << "through the selection's middle";
  options.symmetry_place = -3;
  const document::Edit typed = edit_of({Under::move_handle, 17, Vec3(5, 6, 7)}, options, Pull{Vec3(1, 2, 3), 0, 0});
  EXPECT_EQ(std::get<document::Translate>(typed).shaping.symmetry->point, Vec3(-3, 0, 0));
  EXPECT_EQ(std::get<document::Translate>(typed).by, Vec3(1, 2, 3));
}

TEST(ShapingOptionsTest, rigid_pulls_are_left_for_the_falloff_of_before) {
  ShapingOptions options;
  options.profile = mesh::shape::Profile::sharp;
  turn_rigid(options);
  EXPECT_TRUE(is_rigid(options));
  const document::Edit edit = edit_of({Under::lift_handle, 17}, options, Pull{Vec3::Zero(), 2, 0});
  EXPECT_EQ(std::get<document::Lift>(edit).shaping.weights.falloff.profile, mesh::shape::Profile::constant);
  turn_rigid(options);
  EXPECT_EQ(options.profile, mesh::shape::Profile::sharp);
  options.profile = mesh::shape::Profile::constant;  // by D or the list
  turn_rigid(options);
  EXPECT_FALSE(is_rigid(options));
}

TEST(ShapingOptionsTest, each_part_of_the_handle_has_its_edit) {
  const Axis axis{Vec3(1, 2, 3), Vec3(0, 0, 1)};
  const auto kind = [&](Under handle) {
    return std::string(document::name(edit_of({handle, 1, Vec3::Zero(), axis}, {}, Pull{Vec3(1, 0, 0), 2, 30})));
  };
  EXPECT_EQ(kind(Under::lift_handle), "lift");
  EXPECT_EQ(kind(Under::slide_handle), "slide");
  EXPECT_EQ(kind(Under::move_handle), "translate");
  EXPECT_EQ(kind(Under::turn_handle), "rotate");
  const auto turn = std::get<document::Rotate>(edit_of({Under::turn_handle, 1, Vec3::Zero(), axis}, {}, Pull{Vec3::Zero(), 0, 30}));
  EXPECT_EQ(turn.point, axis.point);
  EXPECT_EQ(turn.axis, axis.direction);
  EXPECT_EQ(turn.degrees, 30);
}

TEST(FalloffDirectionTest, the_key_goes_through_the_axes_and_from_any_other_direction_to_all) {
  FalloffDirection now;
  std::string seen;
  for (int i = 0; i < 5; ++i) {
    seen += now.what + ", ";
    now = next_falloff(now);
  }
  EXPECT_EQ(seen, "all ways, x, y, z, all ways, ");
  EXPECT_TRUE(next_falloff(picked_falloff("crease", Vec3(0, 1, 0))).in_all()) << "along y, but picked";
}

TEST(FalloffDirectionTest, the_views_directions_are_the_screens_in_the_decks_axes) {
  const auto top = *stereo::named_rotation("top");
  FalloffDirection now = falloff_along(DeckAxis::z);
  for (const Vec3& on_screen : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(1, 0, 0)}) {
    now = next_falloff_of_view(now, top);
    EXPECT_NEAR((top * now.direction - on_screen).norm(), 0, 1e-12) << now.what;
  }
  EXPECT_EQ(now.what, "view's right");
  for (const double component : now.direction)
    EXPECT_TRUE(component == 0 || std::abs(component) == 1) << "seen from above the directions are the deck's own, without rests";
  now = next_falloff_of_view(now, *stereo::named_rotation("iso"));
  EXPECT_EQ(now.what, "view's up");
  EXPECT_NEAR(now.direction.norm(), 1, 1e-12);
}

TEST(FalloffDirectionTest, a_picked_direction_reaches_the_edit) {
  ShapingOptions options;
  options.along = picked_falloff("two nodes", Vec3(3, 0, 4));
  const document::Edit edit = edit_of({Under::lift_handle, 1, Vec3::Zero()}, options, Pull{Vec3::Zero(), 1, 0});
  EXPECT_NEAR((*std::get<document::Lift>(edit).shaping.weights.falloff.along - Vec3(0.6, 0, 0.8)).norm(), 0, 1e-12);
  EXPECT_EQ(components_text(options.along.direction), "0.6 0 0.8");
  EXPECT_EQ(components_text(Vec3(-0.0, 1.0 / 3, -1)), "0 0.333 -1");
}

TEST(TypedNumberTest, numbers_are_read_as_people_write_them) {
  EXPECT_EQ(*input::parse_numbers("12.5"), (std::vector<double>{12.5}));
  EXPECT_EQ(*input::parse_numbers(" -1, 2;+3e-1 "), (std::vector<double>{-1, 2, 0.3}));
  for (const char* text : {"", "  ", "abc", "1 two", "1.2.3", "nan", "inf", "1e999", "--1"})
    EXPECT_FALSE(input::parse_numbers(text)) << "\"" << text << "\" was taken";
}

TEST(TypedNumberTest, what_a_tool_makes_of_them) {
  EXPECT_EQ(typed_displacement(Under::lift_handle, "-2.5", {})->distance, -2.5);
  EXPECT_EQ(typed_displacement(Under::turn_handle, "30", {})->degrees, 30);
  EXPECT_EQ(typed_displacement(Under::move_handle, "1 2 3", {})->by, Vec3(1, 2, 3));
  const Pull pulled{Vec3(0, 3, 4), 0, 0};
  EXPECT_NEAR((typed_displacement(Under::slide_handle, "10", pulled)->by - Vec3(0, 6, 8)).norm(), 0, 1e-12) << "the way it was pulled";
  EXPECT_FALSE(typed_displacement(Under::slide_handle, "10", {})) << "nowhere to go";
  EXPECT_FALSE(typed_displacement(Under::slide_handle, "1 2", {}));
  EXPECT_FALSE(typed_displacement(Under::lift_handle, "1 2 3", {}));
  EXPECT_TRUE(input::begins_number("-") && input::begins_number(".") && input::begins_number("7"));
  EXPECT_FALSE(input::begins_number("") || input::begins_number("e"));
}

TEST(TypedNumberTest, the_hint_says_where_a_number_goes) {
  const Vec3 way(0.6, 0, -0.8);
  EXPECT_EQ(typed_hint(Under::lift_handle, way), "distance along the arrow, 0.6 0 -0.8");
  EXPECT_EQ(typed_hint(Under::lift_handle, std::nullopt), "distance, each node along its own normal");
  EXPECT_EQ(typed_hint(Under::turn_handle, Vec3::UnitY()), "degrees about 0 1 0");
  for (const Under handle : {Under::slide_handle, Under::move_handle}) {
    EXPECT_EQ(typed_hint(handle, way), "x y z, or how far along 0.6 0 -0.8");
    EXPECT_EQ(typed_hint(handle, std::nullopt), "x y z in the deck's axes") << "one number would be refused";
  }
}

TEST(ShapingOptionsTest, what_is_of_a_deck_does_not_outlive_it) {
  ShapingOptions options;
  options.flat = 0.3;
  options.each_normal = true;
  options.symmetry = DeckAxis::y;
  options.max_move = 5;
  options.symmetry_place = 100;
  options.along = {"x", Vec3::UnitX()};
  ShapingOptions left = options;
  left.max_move.reset();
  left.symmetry_place.reset();
  EXPECT_EQ(for_another_deck(options), left);
  options.along = picked_falloff("two nodes", Vec3(3, 0, 4));
  left.along = {};
  EXPECT_EQ(for_another_deck(options), left);
}

TEST(AxisPickTest, two_different_nodes_make_an_axis) {
  AxisPick pick;
  EXPECT_FALSE(pick.clicked(Vec3(1, 2, 3))) << "nobody picks";
  pick.begin();
  EXPECT_FALSE(pick.clicked(Vec3(1, 2, 3)));
  EXPECT_FALSE(pick.clicked(Vec3(1, 2, 3))) << "the same node twice is no direction";
  EXPECT_TRUE(pick.active());
  const auto axis = pick.clicked(Vec3(1, 2, 8));
  ASSERT_TRUE(axis);
  EXPECT_EQ(axis->point, Vec3(1, 2, 3));
  EXPECT_NEAR((axis->direction - Vec3::UnitZ()).norm(), 0, 1e-12);
  EXPECT_FALSE(pick.active());
}

/// Two squares in the plane and a third that stands up at their right end, ten wide, seen from above.
TEST(AxisPickTest, the_edge_under_the_pointer_is_found_and_named_creases_and_free_edges_first) {
  test::TestSource model;
  std::array<std::uint32_t, 8> n{};
  for (std::uint32_t i = 0; i < 6; ++i) n[i] = model.add_node(Vec3(10.0 * (i % 3), 10.0 * (i / 3), 0));
  n[6] = model.add_node(Vec3(20, 0, 10));
  n[7] = model.add_node(Vec3(20, 10, 10));
  model.add_shell(n[0], n[1], n[4], n[3], 0);
  const std::uint32_t middle = model.add_shell(n[1], n[2], n[5], n[4], 0);
  model.add_shell(n[5], n[2], n[6], n[7], 0);  // its normal the other way round makes no difference
  stereo::Aim aim;
  aim.view.pivot = Vec3(10, 5, 0);
  aim.view.bounds = {Vec3(10, 5, 5), 20};
  aim.view.rotation = *stereo::named_rotation("top");
  aim.view.mm_per_unit = 10;
  aim.screen_mm = Eigen::Vector2d(480, 270);
  aim.width = 1600;
  aim.height = 900;
  const auto at = [&](double x, double y) {
    return edge_at(model, aim, mesh::ShellIndex(middle), *stereo::pixel_of(aim, Vec3(x, y, 0)), 30);
  };
  const auto crease = at(19, 5);
  ASSERT_TRUE(crease);
  EXPECT_EQ(crease->what, "crease");
  EXPECT_NEAR(std::abs(crease->axis.direction.y()), 1, 1e-12);
  EXPECT_NEAR(crease->axis.point.x(), 20, 1e-12);
  const auto free = at(15, 0.5);
  ASSERT_TRUE(free);
  EXPECT_EQ(free->what, "free edge");
  EXPECT_NEAR(std::abs(free->axis.direction.x()), 1, 1e-12);
  EXPECT_EQ(at(10.3, 5)->what, "element edge") << "with nothing better within reach";
  EXPECT_FALSE(edge_at(model, aim, mesh::ShellIndex(99), input::Pixel(0, 0), 30));
}

TEST(FileExpressionTest, names_are_quoted_by_what_they_dont_hold) {
  EXPECT_EQ(parts::file_expression("parts/hood.k"), "file:\"parts/hood.k\"");
  EXPECT_EQ(parts::file_expression("a\"b.k"), "file:'a\"b.k'");
}

TEST(HistoryFileTest, entries_outlive_the_program_newest_last_each_once) {
  std::string pattern = (std::filesystem::temp_directory_path() / "prismesh-history-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  const std::filesystem::path file = folder / "state" / "expressions";
  {
    HistoryFile history(file);
    EXPECT_TRUE(history.entries().empty());
    for (const char* entry : {"1-100", "part:3", "1-100", ""}) history.add(entry);
    history.add(std::string(HistoryFile::kMaxBytes + 1, '1'));
    history.add("two\nlines");
  }
  EXPECT_EQ(HistoryFile(file).entries(), (std::vector<std::string>{"part:3", "1-100"}));
  {
    HistoryFile history(file);
    for (std::size_t i = 0; i < 2 * HistoryFile::kMax; ++i) history.add(std::to_string(i));
  }
  const HistoryFile history(file);
  ASSERT_EQ(history.entries().size(), HistoryFile::kMax);
  EXPECT_EQ(history.entries().back(), std::to_string(2 * HistoryFile::kMax - 1));
  HistoryFile nowhere{std::filesystem::path()};
  nowhere.add("all");
  EXPECT_EQ(nowhere.entries().size(), 1u);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace prismesh::kiosk::tools::shaping
