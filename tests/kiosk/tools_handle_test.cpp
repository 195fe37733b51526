// Position of the handle on the selection; its displacement follows the pointer's.
#include "kiosk/tools/shaping/handle.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kiosk/toolkit/arrow.h"
#include "kiosk/tools/shaping/handle_outline.h"
#include "kiosk/tools/shaping/shaping_options.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using input::Pixel;
using input::Under;

using ipc::SnapshotArray;

/// A sheet of 9 x 9 nodes in the plane z = 0, ten apart, ids from 101, shells counterclockwise seen from +z.
class Sheet final : public render::ModelSource {
 public:
  static constexpr std::uint32_t kSide = 9;

  explicit Sheet(bool flipped = false) {
    for (std::uint32_t row = 0; row < kSide; ++row)
      for (std::uint32_t column = 0; column < kSide; ++column) {
        positions_.emplace_back(10.0 * column, 10.0 * row, 0);
        ids_.push_back(101 + row * kSide + column);
      }
    marks_.resize(positions_.size());
    for (std::uint32_t row = 0; row + 1 < kSide; ++row)
      for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
        const std::uint32_t n = row * kSide + column;
        mesh::ShellNodes shell{{mesh::NodeIndex(n), mesh::NodeIndex(n + 1), mesh::NodeIndex(n + kSide + 1), mesh::NodeIndex(n + kSide)}};
        if (flipped) std::swap(shell.node[1], shell.node[3]);
        shells_.push_back(shell);
      }
  }
  void select(std::uint32_t row, std::uint32_t column) { marks_[row * kSide + column] = mesh::document::kSelected; }

  std::size_t size(SnapshotArray array) const override {
    switch (array) {
      case SnapshotArray::positions: return positions_.size();
      case SnapshotArray::node_ids: return ids_.size();
      case SnapshotArray::node_marks: return marks_.size();
      case SnapshotArray::shell_nodes: return shells_.size();
      default: return 0;
    }
  }
  std::uint64_t chunk_version(SnapshotArray, std::size_t) const override { return 1; }
  std::span<const std::byte> chunk_bytes(SnapshotArray array, std::size_t) const override {
    switch (array) {
      case SnapshotArray::positions: return std::as_bytes(std::span(positions_));
      case SnapshotArray::node_ids: return std::as_bytes(std::span(ids_));
      case SnapshotArray::node_marks: return std::as_bytes(std::span(marks_));
      case SnapshotArray::shell_nodes: return std::as_bytes(std::span(shells_));
      default: return {};
    }
  }
  std::size_t part_count() const override { return 1; }
  bool part_hidden(std::size_t) const override { return false; }
  std::array<float, 2> part_thickness(std::size_t) const override { return {}; }
  std::uint64_t document_key() const override { return 1; }

 private:
  std::vector<Vec3> positions_;
  std::vector<std::int64_t> ids_;
  std::vector<std::uint8_t> marks_;
  std::vector<mesh::ShellNodes> shells_;
};

/// Looks at the sheet from the side given, the middle of the screen at its middle.
stereo::Aim aim_from(const char* name) {
  stereo::Aim aim;
  aim.view.pivot = Vec3(40, 40, 0);
  aim.view.bounds = {Vec3(40, 40, 0), 60};
  aim.view.rotation = *stereo::named_rotation(name);
  aim.screen_mm = Eigen::Vector2d(480, 270);
  aim.width = 1600;
  aim.height = 900;
  return aim;
}

TEST(HandleTest, nothing_selected_has_no_anchor) { EXPECT_FALSE(anchor_of_selection(Sheet(), std::nullopt).has_value()); }

TEST(HandleTest, the_anchor_is_the_selected_node_nearest_to_the_middle_of_the_selection) {
  Sheet sheet;
  for (const std::uint32_t row : {2u, 3u, 4u})
    for (const std::uint32_t column : {5u, 6u, 7u}) sheet.select(row, column);
  const auto anchor = anchor_of_selection(sheet, std::nullopt);
  ASSERT_TRUE(anchor.has_value());
  EXPECT_EQ(anchor->id, 101 + 3 * 9 + 6);
  EXPECT_EQ(anchor->at, Vec3(60, 30, 0));
  EXPECT_NEAR((anchor->normal - Vec3::UnitZ()).norm(), 0, 1e-12);
}

TEST(HandleTest, the_node_clicked_last_is_the_anchor_while_it_is_selected) {
  Sheet sheet;
  sheet.select(2, 2);
  sheet.select(6, 6);
  EXPECT_EQ(anchor_of_selection(sheet, mesh::NodeIndex(2 * 9 + 2))->id, 101 + 2 * 9 + 2);
  EXPECT_NE(anchor_of_selection(sheet, mesh::NodeIndex(0))->id, 101);
  EXPECT_TRUE(anchor_of_selection(sheet, mesh::NodeIndex(100000)).has_value());
}

TEST(HandleTest, the_normal_has_the_shells_sense_and_the_arrow_the_viewers_side) {
  Sheet sheet(true);
  sheet.select(4, 4);
  const auto anchor = anchor_of_selection(sheet, std::nullopt);
  ASSERT_TRUE(anchor.has_value());
  EXPECT_NEAR((anchor->normal + Vec3::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((arrow_direction(aim_from("iso"), *anchor) - Vec3::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((arrow_direction(aim_from("bottom"), *anchor) + Vec3::UnitZ()).norm(), 0, 1e-12);
}

render::Handle handle_at(const Vec3& at, const Vec3& direction) {
  render::Handle handle;
  handle.at = at;
  handle.direction = direction;
  return handle;
}

TEST(HandleTest, ring_arrow_and_disk_are_told_apart) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0);
  const render::Handle handle = handle_at(at, Vec3::UnitZ());
  const Pixel foot = *stereo::pixel_of(aim, at), tip = *stereo::pixel_of(aim, stereo::handle_tip(aim, at, Vec3::UnitZ()));
  EXPECT_EQ(part_of_handle(aim, handle, foot), Under::move_handle);
  EXPECT_EQ(part_of_handle(aim, handle, tip), Under::lift_handle);
  EXPECT_EQ(part_of_handle(aim, handle, foot + Pixel(25, 0)), Under::slide_handle);
  EXPECT_EQ(part_of_handle(aim, handle, foot + Pixel(0, 32)), Under::picture) << "the disk is foreshortened";
  EXPECT_EQ(part_of_handle(aim, handle, foot + Pixel(100, 0)), Under::picture);
}

TEST(HandleTest, an_arrow_toward_the_viewer_is_what_lies_under_its_foot) {
  const stereo::Aim aim = aim_from("top");
  const Vec3 at(40, 40, 0);
  EXPECT_TRUE(toolkit::points_at_viewer(aim, at, Vec3::UnitZ()));
  EXPECT_EQ(part_of_handle(aim, handle_at(at, Vec3::UnitZ()), *stereo::pixel_of(aim, at)), Under::lift_handle);
}

TEST(HandleTest, a_handle_with_an_axis_has_its_ball_and_circle_only) {
  const stereo::Aim aim = aim_from("top");
  render::Handle handle = handle_at(Vec3(60, 40, 0), Vec3::UnitZ());
  handle.turn = render::Handle::Turn{Vec3(40, 40, 0), Vec3::UnitZ(), 0};
  EXPECT_EQ(part_of_handle(aim, handle, *stereo::pixel_of(aim, Vec3(60, 40, 0))), Under::turn_handle);
  EXPECT_EQ(part_of_handle(aim, handle, *stereo::pixel_of(aim, Vec3(40, 60, 0))), Under::turn_handle);
  EXPECT_EQ(part_of_handle(aim, handle, *stereo::pixel_of(aim, Vec3(40, 40, 0))), Under::picture);
}

TEST(HandleTest, the_ball_of_an_axis_through_the_grab_stands_beside_it) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0);
  const Axis through{at, Vec3::UnitZ()};
  const Vec3 ball = ball_place(aim, through, at);
  EXPECT_NEAR((ball - at).dot(Vec3::UnitZ()), 0, 1e-9) << "on a circle about the axis";
  EXPECT_GT((*stereo::pixel_of(aim, ball) - *stereo::pixel_of(aim, at)).norm(), 60);
  const Axis beside{Vec3(-20, 40, 0), Vec3::UnitZ()};
  EXPECT_EQ(ball_place(aim, beside, at), at);
}

TEST(HandleTest, the_disk_keeps_what_is_under_the_pointer_in_its_plane) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0), taken(43, 41, 0), to(70, 25, 0);
  const HandlePull pull({Under::slide_handle, at, Vec3::UnitZ(), std::nullopt, *stereo::pixel_of(aim, taken)}, aim);
  const Pull pulled = pull.at(aim, *stereo::pixel_of(aim, to));
  EXPECT_NEAR((pulled.by - (to - taken)).norm(), 0, 1e-6);
}

TEST(HandleTest, a_disk_seen_from_its_edge_goes_across_the_screen) {
  const stereo::Aim aim = aim_from("front");
  const Vec3 at(40, 40, 0);
  const Pixel taken = *stereo::pixel_of(aim, at);
  const HandlePull pull({Under::slide_handle, at, Vec3::UnitZ(), std::nullopt, taken}, aim);
  const Vec3 by = pull.at(aim, taken + Pixel(40, 30)).by;
  EXPECT_GT(by.x(), 5);
  EXPECT_NEAR(by.z(), 0, 1e-9) << "up on the screen leads out of the plane";
}

TEST(HandleTest, the_ball_turns_by_the_angle_that_the_pointer_goes_and_more_than_once) {
  const stereo::Aim aim = aim_from("top");
  const Vec3 centre(40, 40, 0), at(60, 40, 0);
  const Axis axis{centre, Vec3::UnitZ()};
  const HandlePull pull({Under::turn_handle, at, Vec3::UnitZ(), axis, *stereo::pixel_of(aim, at)}, aim);
  Pull pulled;
  for (int degrees = 10; degrees <= 400; degrees += 10) {
    const double angle = degrees * std::acos(-1.0) / 180;
    pulled = pull.at(aim, *stereo::pixel_of(aim, centre + 27 * Vec3(std::cos(angle), std::sin(angle), 0)), pulled);
    ASSERT_NEAR(pulled.degrees, degrees, 1e-6);
  }
  EXPECT_NEAR(
      (pull.foot(pulled) - (centre + 20 * Vec3(std::cos(40 * std::acos(-1.0) / 180), std::sin(40 * std::acos(-1.0) / 180), 0))).norm(), 0,
      1e-6);
}

TEST(HandleTest, a_circle_seen_from_its_edge_turns_by_moving_along_it) {
  const stereo::Aim aim = aim_from("front");  // the axis lies up the screen, the ball before it
  const Vec3 at(40, 20, 0);
  const HandlePull pull({Under::turn_handle, at, Vec3::UnitZ(), Axis{Vec3(40, 40, 0), Vec3::UnitZ()}, *stereo::pixel_of(aim, at)}, aim);
  const Pixel ball = *stereo::pixel_of(aim, at);
  const double one = (*stereo::pixel_of(aim, pull.foot(Pull{Vec3::Zero(), 0, 1})) - ball).norm();
  EXPECT_NEAR(pull.at(aim, ball + Pixel(25 * one, 0)).degrees, 25, 0.1);
  EXPECT_NEAR(pull.at(aim, ball - Pixel(25 * one, 0)).degrees, -25, 0.1);
}

/// Orbit and zoom in the middle of a pull.
TEST(HandleTest, what_is_pulled_stays_where_it_is_when_the_view_moves) {
  const Vec3 at(40, 40, 0), up = Vec3::UnitZ();
  const Axis axis{Vec3(20, 40, 0), up};
  for (const Under handle : {Under::lift_handle, Under::slide_handle, Under::move_handle, Under::turn_handle}) {
    const stereo::Aim before = aim_from("iso");
    stereo::Aim after = before;
    after.view = stereo::zoom(stereo::orbit(before.view, 0.5, -0.2), 1.7, Eigen::Vector2d(30, 10));
    const Pixel taken = *stereo::pixel_of(before, at), to = taken + Pixel(35, -28), pointer(900, 300);
    HandlePull pull({handle, at, up, handle == Under::turn_handle ? std::optional(axis) : std::nullopt, taken}, before);
    pull.set_axis(before, at, -up);
    const Pull pulled = pull.at(before, to);
    pull.hold(after, pointer, pulled);
    const Pull held = pull.at(after, pointer, pulled);
    EXPECT_NEAR((held.by - pulled.by).norm(), 0, 1e-9) << name_of(handle);
    EXPECT_NEAR(held.distance, pulled.distance, 1e-9) << name_of(handle);
    EXPECT_NEAR(held.degrees, pulled.degrees, 1e-9) << name_of(handle);
    const Pull on = pull.at(after, pointer + Pixel(20, -20), held);
    EXPECT_GT((pull.foot(on) - pull.foot(pulled)).norm(), 0.1) << name_of(handle) << " goes on from there";
    EXPECT_LT((pull.foot(on) - pull.foot(pulled)).norm(), 60) << name_of(handle);
  }
}

TEST(HandleTest, a_lift_follows_the_pointer_along_the_arrow_from_wherever_it_was_taken) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0), up = Vec3::UnitZ();
  const Pixel taken = *stereo::pixel_of(aim, at + 6 * up);
  const HandlePull pull({Under::lift_handle, at, up, std::nullopt, taken}, aim);
  EXPECT_NEAR(pull.at(aim, taken).distance, 0, 1e-9);
  const Pull pulled = pull.at(aim, *stereo::pixel_of(aim, at + 21 * up));
  EXPECT_NEAR(pulled.distance, 15, 1e-6);
  EXPECT_EQ(pulled.by, Vec3(0, 0, 0));
  EXPECT_NEAR((pull.foot(pulled) - Vec3(40, 40, 15)).norm(), 0, 1e-6);
}

TEST(HandleTest, a_normal_of_the_other_sense_changes_the_distances_sign_only) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0), up = Vec3::UnitZ();
  HandlePull pull({Under::lift_handle, at, up, std::nullopt, *stereo::pixel_of(aim, at)}, aim);
  pull.set_axis(aim, at, -up);
  const Pull pulled = pull.at(aim, *stereo::pixel_of(aim, at + 10 * up));
  EXPECT_NEAR(pulled.distance, -10, 1e-6);
  EXPECT_NEAR((pull.foot(pulled) - Vec3(40, 40, 10)).norm(), 0, 1e-6);
  EXPECT_NEAR((pull.direction() - up).norm(), 0, 1e-12);
}

TEST(HandleTest, an_arrow_toward_the_viewer_is_pulled_by_moving_up) {
  stereo::Aim aim = aim_from("top");
  const Vec3 at(40, 40, 0);
  for (const double scale : {1.0, 4.0, 0.25}) {
    aim.view.mm_per_unit = scale;
    const Pixel taken = *stereo::pixel_of(aim, at);
    const HandlePull pull({Under::lift_handle, at, Vec3::UnitZ(), std::nullopt, taken}, aim);
    const double distance = pull.at(aim, taken - Pixel(0, 50)).distance;
    EXPECT_NEAR(distance, 50 * aim.mm_per_pixel() / scale, 1e-9);
    EXPECT_NEAR((*stereo::pixel_of(aim, at + Vec3(0, distance, 0)) - taken).norm(), 50, 1e-6)
        << "the handle must move as far as the pointer on the screen";
    EXPECT_NEAR(pull.at(aim, taken + Pixel(300, 0)).distance, 0, 1e-9);
  }
}

TEST(HandleTest, the_ring_moves_in_the_screens_plane_under_the_pointer) {
  const stereo::Aim aim = aim_from("front");
  const Vec3 at(40, 40, 0);
  const Pixel foot = *stereo::pixel_of(aim, at), taken = foot + Pixel(3, -2);
  const HandlePull pull({Under::move_handle, at, Vec3::UnitZ(), std::nullopt, taken}, aim);
  EXPECT_NEAR(pull.at(aim, taken).by.norm(), 0, 1e-9);
  const Vec3 by = pull.at(aim, taken + Pixel(40, 25)).by;
  EXPECT_NEAR(by.y(), 0, 1e-9);  // front looks along +y
  EXPECT_NEAR((*stereo::pixel_of(aim, at + by) - (foot + Pixel(40, 25))).norm(), 0, 1e-6);
}

TEST(HandleOutlineTest, what_is_highlighted_is_what_a_press_takes) {
  const render::Handle handle = handle_at(Vec3(40, 40, 0), Vec3(0, 0, 1));
  for (const char* view : {"iso", "front", "top"})
    for (const Under part : {Under::lift_handle, Under::slide_handle, Under::move_handle}) {
      if (part == Under::slide_handle && view == std::string("front")) continue;  // seen from its edge
      if (part == Under::move_handle && view == std::string("top")) continue;     // the arrow is in front of it
      const stereo::Aim aim = aim_from(view);
      const Pixel foot = *stereo::pixel_of(aim, handle.at);
      int taken = 0, points = 0;
      for (const std::vector<Pixel>& line : outline_of_part(aim, handle, part))
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
          for (double share = 0; share < 1; share += 0.125, ++points) {
            Pixel at = line[i] + share * (line[i + 1] - line[i]);
            at += 1e-3 * (foot - at);  // a rim's pixel is on neither side
            const Under found = part_of_handle(aim, handle, at);
            EXPECT_NE(found, Under::picture) << view << " at " << at.transpose();
            taken += found == part ? 1 : 0;
          }
      ASSERT_GT(points, 0) << view;
      EXPECT_GT(taken, points / 2) << view << " part " << static_cast<int>(part);
    }
}

TEST(HandleOutlineTest, an_axis_has_its_circle_and_its_ball_and_the_arrow_ends_at_its_tip) {
  const stereo::Aim aim = aim_from("iso");
  render::Handle handle = handle_at(Vec3(60, 40, 0), Vec3(0, 0, 1));
  const auto arrow = outline_of_part(aim, handle, Under::lift_handle);
  ASSERT_EQ(arrow.size(), 1U);
  EXPECT_EQ(arrow[0].back(), *stereo::pixel_of(aim, stereo::handle_tip(aim, handle.at, handle.direction)));
  EXPECT_TRUE(outline_of_part(aim, handle, Under::turn_handle).empty()) << "there is no axis";
  handle.turn = render::Handle::Turn{Vec3(40, 40, 0), Vec3(0, 0, 1), 0};
  const auto lines = outline_of_part(aim, handle, Under::turn_handle);
  ASSERT_EQ(lines.size(), 2U);
  for (const auto& line : lines)
    for (const Pixel& at : line) EXPECT_EQ(part_of_handle(aim, handle, at), Under::turn_handle);
  const Pixel opposite = *stereo::pixel_of(aim, Vec3(20, 40, 0));
  double nearest = 1e9;
  for (const Pixel& at : lines[0]) nearest = std::min(nearest, (at - opposite).norm());
  EXPECT_LT(nearest, 1e-6) << "the circle goes all about the axis";
  // Behind the eye.
  EXPECT_TRUE(outline_of_part(aim, handle_at(stereo::to_deck(aim.view, Vec3(0, 0, 2 * aim.eye_mm.z())), Vec3(0, 0, 1)), Under::move_handle)
                  .empty());
}

}  // namespace
}  // namespace prismesh::kiosk::tools::shaping
