// The handle stands on the selection and is pulled by as much as the pointer goes.
#include "kiosk/tools/handle.h"

#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::kiosk::tools {
namespace {

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

TEST(HandleTest, ring_and_arrow_are_told_apart) {
  const stereo::Aim aim = aim_from("front");  // the arrow points up on the screen
  const Vec3 at(40, 40, 0);
  const Pixel foot = *stereo::pixel_of(aim, at), tip = *stereo::pixel_of(aim, stereo::handle_tip(aim, at, Vec3::UnitZ()));
  EXPECT_LT(tip.y(), foot.y() - 60);
  EXPECT_EQ(part_of_handle(aim, at, Vec3::UnitZ(), foot), Under::move_handle);
  EXPECT_EQ(part_of_handle(aim, at, Vec3::UnitZ(), tip), Under::lift_handle);
  EXPECT_EQ(part_of_handle(aim, at, Vec3::UnitZ(), foot + Pixel(100, 0)), Under::picture);
}

TEST(HandleTest, an_arrow_toward_the_viewer_is_what_lies_under_its_foot) {
  const stereo::Aim aim = aim_from("top");
  const Vec3 at(40, 40, 0);
  EXPECT_TRUE(points_at_viewer(aim, at, Vec3::UnitZ()));
  EXPECT_EQ(part_of_handle(aim, at, Vec3::UnitZ(), *stereo::pixel_of(aim, at)), Under::lift_handle);
}

TEST(HandleTest, a_lift_follows_the_pointer_along_the_arrow_from_wherever_it_was_taken) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0), up = Vec3::UnitZ();
  const Pixel taken = *stereo::pixel_of(aim, at + 6 * up);
  const HandlePull pull(Under::lift_handle, at, up, aim, taken);
  EXPECT_NEAR(pull.at(aim, taken).distance, 0, 1e-9);
  const Pull pulled = pull.at(aim, *stereo::pixel_of(aim, at + 21 * up));
  EXPECT_NEAR(pulled.distance, 15, 1e-6);
  EXPECT_EQ(pulled.by, Vec3(0, 0, 0));
  EXPECT_NEAR((pull.foot(pulled) - Vec3(40, 40, 15)).norm(), 0, 1e-6);
}

TEST(HandleTest, a_normal_of_the_other_sense_changes_the_distances_sign_only) {
  const stereo::Aim aim = aim_from("iso");
  const Vec3 at(40, 40, 0), up = Vec3::UnitZ();
  HandlePull pull(Under::lift_handle, at, up, aim, *stereo::pixel_of(aim, at));
  pull.set_axis(aim, at, -up);
  const Pull pulled = pull.at(aim, *stereo::pixel_of(aim, at + 10 * up));
  EXPECT_NEAR(pulled.distance, -10, 1e-6);
  EXPECT_NEAR((pull.foot(pulled) - Vec3(40, 40, 10)).norm(), 0, 1e-6);
  EXPECT_NEAR((pull.direction() - up).norm(), 0, 1e-12);
}

TEST(HandleTest, an_arrow_toward_the_viewer_is_pulled_by_moving_up) {
  const stereo::Aim aim = aim_from("top");
  const Vec3 at(40, 40, 0);
  const Pixel taken = *stereo::pixel_of(aim, at);
  const HandlePull pull(Under::lift_handle, at, Vec3::UnitZ(), aim, taken);
  EXPECT_NEAR(pull.at(aim, taken - Pixel(0, 50)).distance, 50 * aim.mm_per_pixel(), 1e-9);
  EXPECT_NEAR(pull.at(aim, taken + Pixel(300, 0)).distance, 0, 1e-9);
}

TEST(HandleTest, the_ring_moves_in_the_screens_plane_under_the_pointer) {
  const stereo::Aim aim = aim_from("front");
  const Vec3 at(40, 40, 0);
  const Pixel foot = *stereo::pixel_of(aim, at), taken = foot + Pixel(3, -2);
  const HandlePull pull(Under::move_handle, at, Vec3::UnitZ(), aim, taken);
  EXPECT_NEAR(pull.at(aim, taken).by.norm(), 0, 1e-9);
  const Vec3 by = pull.at(aim, taken + Pixel(40, 25)).by;
  EXPECT_NEAR(by.y(), 0, 1e-9);  // front looks along +y
  EXPECT_NEAR((*stereo::pixel_of(aim, at + by) - (foot + Pixel(40, 25))).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace prismesh::kiosk::tools
