// Selected nodes, the handle and the lasso in the picture, and the bytes that a frame of a drag uploads.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "kiosk/render/handle_mesh.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using ipc::SnapshotArray;
using mesh::Vec3;
using test::TestSource;
using test::two_plates;

constexpr int kMarksWidth = 640, kMarksHeight = 400;

constexpr std::size_t kFront = 60, kBehind = 121 + 37;

/// The pixels in which two pictures differ.
struct Blob {
  std::size_t pixels = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2i low = Eigen::Vector2i::Constant(1 << 20), high = Eigen::Vector2i::Constant(-1);
};
Blob difference(const Image& a, const Image& b, int x0, int x1) {
  Blob blob;
  for (int y = 0; y < a.height; ++y)
    for (int x = x0; x < x1; ++x) {
      if (std::abs(brightness(a, x, y) - brightness(b, x, y)) < 12) continue;
      ++blob.pixels;
      blob.centre += Eigen::Vector2d(x + 0.5, y + 0.5);
      blob.low = blob.low.cwiseMin(Eigen::Vector2i(x, y));
      blob.high = blob.high.cwiseMax(Eigen::Vector2i(x, y));
    }
  if (blob.pixels > 0) blob.centre /= static_cast<double>(blob.pixels);
  return blob;
}
Blob difference(const Image& a, const Image& b) { return difference(a, b, 0, a.width); }

class EditingMarks : public RenderTest {
 protected:
  Eigen::Vector2d pixel_of(const Picture& picture, const Vec3& point) const {
    return *stereo::pixel_of(aim_of(picture, kMarksWidth, kMarksHeight), point);
  }
  static const std::uint8_t* at(const Image& image, const Eigen::Vector2d& pixel) {
    return image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }
  static bool green(const std::uint8_t* pixel) { return pixel[1] > pixel[0] * 4 / 3 && pixel[1] > pixel[2] * 5 / 4; }
  /// The pixels that change when only these nodes are selected.
  Blob marks(TestSource source, const Picture& picture, std::initializer_list<std::size_t> nodes, int x0 = 0, int x1 = kMarksWidth) {
    show(source);
    const Image without = draw(picture, kMarksWidth, kMarksHeight);
    for (const std::size_t node : nodes) source.node_marks[node] = mesh::document::kSelected;
    source.key = 2;
    show(source);
    return difference(draw(picture, kMarksWidth, kMarksHeight), without, x0, x1);
  }
  /// The pixels that a handle changes.
  Blob handle(Picture picture, const Handle& shown) {
    const Image without = draw(picture, kMarksWidth, kMarksHeight);
    picture.handle = shown;
    return difference(draw(picture, kMarksWidth, kMarksHeight), without);
  }
};

TEST_F(EditingMarks, a_selected_node_keeps_its_size_whatever_the_zoom) {
  show(two_plates());
  Picture picture = fitted("mono", "iso", kMarksWidth, kMarksHeight);
  picture.element_edges = false;
  const Blob small = marks(two_plates(), picture, {kFront});
  picture.view = stereo::zoom(picture.view, 2.2, {0, 0});
  const Blob large = marks(two_plates(), picture, {kFront});
  EXPECT_GT(small.pixels, 40U);
  EXPECT_NEAR(static_cast<double>(large.pixels), static_cast<double>(small.pixels), 0.15 * static_cast<double>(small.pixels));
  EXPECT_NEAR((large.high - large.low).x(), (small.high - small.low).x(), 1);
  EXPECT_NEAR((large.high - large.low).y(), (small.high - small.low).y(), 1);
}

TEST_F(EditingMarks, a_selected_node_has_the_parallax_of_its_position) {
  show(two_plates());
  Picture picture = fitted("side-by-side", "top", kMarksWidth, kMarksHeight);
  picture.element_edges = false;
  picture.view.depth_strength = 1.5;
  const stereo::PictureEyes eyes{picture.between_eyes_mm, picture.toward_right, picture.eye_separation_mm, 1};
  std::array<double, 2> parallax{};
  for (const std::size_t node : {kFront, kBehind}) {
    std::array<double, 2> x{};
    for (const stereo::Eye eye : {stereo::Eye::left, stereo::Eye::right}) {
      const bool right = eye == stereo::Eye::right;
      const Blob blob = marks(two_plates(), picture, {node}, right ? kMarksWidth / 2 : 0, right ? kMarksWidth : kMarksWidth / 2);
      ASSERT_GT(blob.pixels, 5U);
      stereo::Aim aim = aim_of(picture, kMarksWidth, kMarksHeight);
      aim.eye_mm = eyes.picture_eye(eye);
      const Eigen::Vector2d expected = *stereo::pixel_of(aim, two_plates().positions[node]);
      x[right ? 1 : 0] = 2 * (blob.centre.x() - (right ? kMarksWidth / 2 : 0));
      EXPECT_NEAR(x[right ? 1 : 0], expected.x(), 1.0) << node << (right ? " right" : " left");
      EXPECT_NEAR(blob.centre.y(), expected.y(), 0.7);
    }
    parallax[node == kFront ? 0 : 1] = x[1] - x[0];
  }
  EXPECT_LT(parallax[0], -3) << "in front of the screen: the right eye sees it farther left";
  EXPECT_GT(parallax[1], 3) << "behind it";
}

TEST_F(EditingMarks, selecting_uploads_only_the_chunks_that_change) {
  TestSource source;
  test::add_grid(source, 200, 200, 0, [](double u, double v) { return Vec3(u, v, 0); });
  show(source);
  const auto bytes = [&] { return renderer_->figures().bytes_uploaded; };
  std::size_t before = bytes();
  for (const std::size_t node : {7U, 8U, 1000U}) source.node_marks[node] = mesh::document::kSelected;
  source.touch(SnapshotArray::node_marks, 0);
  show(source);
  EXPECT_EQ(bytes() - before, 2 * 3 * sizeof(std::uint32_t)) << "as selected, and as on no selected face";
  before = bytes();
  source.node_marks[5 * mesh::kChunkSize + 3] = mesh::document::kSelected;
  source.touch(SnapshotArray::node_marks, 5);
  show(source);
  EXPECT_EQ(bytes() - before, 2 * sizeof(std::uint32_t)) << "the first chunk's row is not uploaded again";
}

TEST_F(EditingMarks, crowded_selected_nodes_are_all_drawn) {
  TestSource source;
  test::add_grid(source, 400, 250, 0, [](double u, double v) { return Vec3(u * 100 - 50, v * 60 - 30, 0); });
  show(source);
  const Picture picture = fitted("mono", "top", kMarksWidth, kMarksHeight);
  for (std::size_t n = 0; n < source.node_marks.size(); ++n) source.node_marks[n] = n % 401 < 200 ? mesh::document::kSelected : 0;
  source.key = 2;
  show(source);
  const Image image = draw(picture, kMarksWidth, kMarksHeight);
  for (const double y : {-25.0, 0.0, 25.0}) {
    double selected = 0, plain = 0;
    for (int x = -40; x < -10; ++x) {
      selected += at(image, pixel_of(picture, {static_cast<double>(x), y, 0}))[2] / 30.0;
      plain += at(image, pixel_of(picture, {static_cast<double>(-x), y, 0}))[2] / 30.0;
    }
    EXPECT_GT(selected, plain + 40);
  }
}

TEST_F(EditingMarks, selected_nodes_of_hidden_parts_are_not_drawn_and_come_back) {
  show(two_plates());
  Picture picture = fitted("mono", "top", kMarksWidth, kMarksHeight);
  TestSource source = two_plates();
  source.node_marks[kBehind] = mesh::document::kSelected;
  source.key = 2;
  show(source);
  const Image marked = draw(picture, kMarksWidth, kMarksHeight);
  source.hidden[1] = true;
  show(source);
  const Image hidden = draw(picture, kMarksWidth, kMarksHeight);
  EXPECT_GT(difference(marked, hidden).pixels, 20U);
  source.shell_parts[0] = mesh::PartIndex(1);  // hides a shell of the front plate as well: only this shell uses its corner
  source.touch(SnapshotArray::shell_parts, 0);
  source.node_marks[0] = mesh::document::kSelected;
  source.touch(SnapshotArray::node_marks, 0);
  show(source);
  const Image corner_gone = draw(picture, kMarksWidth, kMarksHeight);
  source.node_marks[0] = 0;
  source.touch(SnapshotArray::node_marks, 0);
  show(source);
  EXPECT_EQ(draw(picture, kMarksWidth, kMarksHeight).rgb, corner_gone.rgb);
  source.shell_parts[0] = mesh::PartIndex(0);
  source.touch(SnapshotArray::shell_parts, 0);
  source.hidden[1] = false;
  show(source);
  EXPECT_EQ(draw(picture, kMarksWidth, kMarksHeight).rgb, marked.rgb);
}

TEST_F(EditingMarks, the_active_part_is_green_and_the_others_are_hidden) {
  show(two_plates());
  Picture picture = fitted("mono", "iso", kMarksWidth, kMarksHeight);
  const Vec3 foot(0, 0, 20);
  const stereo::Aim aim = aim_of(picture, kMarksWidth, kMarksHeight);
  const double deck_pixel = aim.mm_per_pixel() / aim.view.mm_per_unit;
  const auto on_disk = [&](double x, double y) {
    return pixel_of(picture, foot + Vec3(x, y, 0) * (0.72 * kHandleDiskPixels * deck_pixel));
  };
  const Eigen::Vector2d arrow = pixel_of(picture, stereo::handle_tip(aim, foot, Vec3::UnitZ())) + Eigen::Vector2d(0, 12);
  const Eigen::Vector2d disk = on_disk(1, 0);
  const Eigen::Vector2d ring = pixel_of(picture, foot) + Eigen::Vector2d(kHandleRingPixels, 0);
  using Use = Handle::Use;
  const std::array<std::pair<Use, Eigen::Vector2d>, 3> parts{{{Use::arrow, arrow}, {Use::disk, disk}, {Use::ring, ring}}};
  const Image without = draw(picture, kMarksWidth, kMarksHeight);
  for (const Use use : {Use::idle, Use::arrow, Use::disk, Use::ring}) {
    picture.handle = Handle{foot, Vec3::UnitZ(), use};
    const Image image = draw(picture, kMarksWidth, kMarksHeight);
    for (const auto& [part, pixel] : parts) {
      const bool there = use == Use::idle || use == part;
      if (use == Use::disk && part == Use::ring) continue;  // the disk covers the ring
      EXPECT_EQ(green(at(image, pixel)), use == part) << static_cast<int>(use) << " at " << static_cast<int>(part);
      if (there || part != Use::disk) continue;
      EXPECT_TRUE(std::equal(at(image, pixel), at(image, pixel) + 3, at(without, pixel))) << "nothing is left of the disk";
    }
  }
  picture.handle = Handle{foot, Vec3::UnitZ(), Use::disk};
  const Image image = draw(picture, kMarksWidth, kMarksHeight);
  for (const auto& [x, y] : {std::pair{-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) EXPECT_TRUE(green(at(image, on_disk(x, y)))) << x << y;
}

TEST_F(EditingMarks, the_handle_keeps_its_size_and_shows_through_the_model) {
  show(two_plates());
  Picture picture = fitted("mono", "top", kMarksWidth, kMarksHeight);
  const Handle shown{{0, 0, 20}, Vec3::UnitZ(), Handle::Use::disk};
  const double small = static_cast<double>(handle(picture, shown).pixels);
  Handle behind = shown;
  behind.at.z() = -10;
  const Blob dimmed = handle(picture, behind);
  EXPECT_GT(static_cast<double>(dimmed.pixels), 0.3 * small) << "can be grabbed though it is hidden";
  const Image without = draw(picture, kMarksWidth, kMarksHeight);
  picture.handle = behind;
  const Image image = draw(picture, kMarksWidth, kMarksHeight);
  picture.handle = shown;
  const Image before = draw(picture, kMarksWidth, kMarksHeight);
  const auto strength = [&](const Image& with) {
    int max = 0;
    for (int y = 0; y < kMarksHeight; ++y)
      for (int x = 0; x < kMarksWidth; ++x) max = std::max(max, std::abs(brightness(with, x, y) - brightness(without, x, y)));
    return max;
  };
  EXPECT_LT(strength(image), 0.6 * strength(before)) << "but dimmed";
  picture.handle.reset();
  picture.view = stereo::zoom(picture.view, 2, {0, 0});
  EXPECT_NEAR(static_cast<double>(handle(picture, shown).pixels), small, 0.06 * small);
}

TEST_F(EditingMarks, an_arc_runs_from_the_grabbed_position_to_the_current_one) {
  show(two_plates());
  Picture picture = fitted("mono", "top", kMarksWidth, kMarksHeight);
  Handle turned{{0, 25, 20}, Vec3::UnitZ(), Handle::Use::arc};
  turned.turn = Handle::Turn{{0, 0, 0}, Vec3::UnitZ(), 90};
  picture.handle = turned;
  const Image image = draw(picture, kMarksWidth, kMarksHeight);
  const auto place = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return pixel_of(picture, Vec3(25 * std::cos(angle), 25 * std::sin(angle), 20));
  };
  for (const double degrees : {10.0, 40.0, 80.0}) EXPECT_TRUE(green(at(image, place(degrees)))) << degrees;
  for (const double degrees : {-20.0, 130.0, 200.0}) EXPECT_FALSE(green(at(image, place(degrees)))) << degrees;
  EXPECT_TRUE(green(at(image, place(90)))) << "the ball";
  picture.handle->turn->degrees = -90;
  const Image other = draw(picture, kMarksWidth, kMarksHeight);
  EXPECT_TRUE(green(at(other, place(130)))) << "turned the other way";
  EXPECT_FALSE(green(at(other, place(40))));
  picture.handle->use = Handle::Use::idle;
  const Image idle = draw(picture, kMarksWidth, kMarksHeight);
  for (const double degrees : {90.0, 130.0}) EXPECT_FALSE(green(at(idle, place(degrees))));
}

TEST_F(EditingMarks, the_axis_goes_through_the_model_and_extends_beyond_it) {
  show(two_plates());
  Picture picture = fitted("mono", "front", kMarksWidth, kMarksHeight);
  Handle turned{{30, 0, 20}, Vec3::UnitZ(), Handle::Use::idle};
  turned.turn = Handle::Turn{{10, 0, 3}, Vec3::UnitZ(), 0};
  const Blob blob = handle(picture, turned);
  EXPECT_LT(blob.low.y(), pixel_of(picture, {10, 0, 20}).y() - 15);
  EXPECT_GT(blob.high.y(), pixel_of(picture, {10, 0, -20}).y() + 15);
}

HandleSpace space_of(const stereo::View& view) {
  HandleSpace space{view, 0.28, 650, {}};
  space.around.add(Vec3(-50, -30, -20));
  space.around.add(Vec3(50, 30, 20));
  return space;
}

TEST(HandleMesh, faces_look_outward) {
  const stereo::View view;
  Handle turned{{30, 5, 10}, Vec3(1, 2, 3), Handle::Use::idle};
  for (const bool turn : {false, true}) {
    if (turn) turned.turn = Handle::Turn{{0, 0, 0}, Vec3(1, 1, 3).normalized(), 77};
    const std::vector<HandlePiece> pieces = handle_pieces(turned, space_of(view));
    ASSERT_GE(pieces.size(), 3U);
    for (const HandlePiece& piece : pieces) {
      if (piece.sheet) continue;
      ASSERT_EQ(piece.triangles.size() % 3, 0U);
      for (std::size_t i = 0; i < piece.triangles.size(); i += 3) {
        std::array<Eigen::Vector3f, 3> p;
        Eigen::Vector3f outward = Eigen::Vector3f::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
          p[k] = Eigen::Vector3f(piece.triangles[i + k].at.data());
          outward += Eigen::Vector3f(piece.triangles[i + k].outward.data());
        }
        const Eigen::Vector3f normal = (p[1] - p[0]).cross(p[2] - p[0]);
        if (normal.norm() > 1e-4F) {
          EXPECT_GT(normal.dot(outward), 0) << turn << " triangle " << i / 3;
        }
      }
    }
  }
}

/// The box around a piece, screen mm.
stereo::Box box_of(const HandlePiece& piece) {
  stereo::Box box;
  for (const HandleVertex& vertex : piece.triangles) box.add(Eigen::Vector3f(vertex.at.data()).cast<double>());
  return box;
}

TEST(PenMesh, the_tip_is_where_the_pen_is_and_the_shaft_goes_to_the_hand) {
  stereo::View view;
  view.mm_per_unit = 2;
  view.bounds = {Vec3::Zero(), 10};
  Pen pen;
  pen.tip = {10, -5, 8};
  pen.shaft = Vec3(1, 1, 1).normalized();
  const Vec3 tip = stereo::to_screen(view, pen.tip);
  ASSERT_GT(std::abs(tip.z()), 1) << "it has depth";
  std::vector<HandlePiece> pieces = pen_pieces(pen, space_of(view));
  ASSERT_EQ(pieces.size(), 2U);
  const stereo::Box cone = box_of(pieces[0]), shaft = box_of(pieces[1]);
  EXPECT_LT((cone.low - tip).norm(), 3) << "its foremost point";
  EXPECT_LT((Eigen::Vector3f(pieces[0].triangles[0].at.data()).cast<double>() - tip).norm(), 0.1);
  const double pixel = 0.28 * (650 - tip.z()) / 650, along = kPenLengthPixels * pixel / std::sqrt(3.0);
  EXPECT_NEAR(shaft.high.x(), tip.x() + along, 6 * pixel);
  EXPECT_NEAR(shaft.high.y(), tip.y() + along, 6 * pixel);
  EXPECT_NEAR(shaft.high.z(), tip.z() + along * stereo::depth_scale(view), 6 * pixel) << "in the depth that the model has";
  EXPECT_FALSE(pieces[0].active);
  pen.busy = true;
  pieces = pen_pieces(pen, space_of(view));
  EXPECT_TRUE(pieces[0].active);
  EXPECT_FALSE(pieces[1].active);
}

TEST(PenMesh, what_it_touches_is_marked) {
  const stereo::View view;
  Pen pen;
  pen.tip = {10, -5, 8};
  pen.shell = {{Vec3(0, 0, 0), Vec3(5, 0, 0)}, {Vec3(5, 0, 0), Vec3(0, 5, 0)}};
  pen.node = Vec3(5, 0, 0);
  const std::vector<HandlePiece> pieces = pen_pieces(pen, space_of(view));
  ASSERT_EQ(pieces.size(), 4U);
  EXPECT_TRUE(pieces[0].active && pieces[1].active);
  const stereo::Box node = box_of(pieces[1]);
  EXPECT_LT((0.5 * (node.low + node.high) - stereo::to_screen(view, *pen.node)).norm(), 0.1);
}

TEST(PenMesh, faces_look_outward) {
  Pen pen;
  pen.tip = {10, -5, 8};
  pen.shaft = Vec3(1, -2, 3).normalized();
  pen.node = Vec3(5, 0, 0);
  for (const HandlePiece& piece : pen_pieces(pen, space_of(stereo::View())))
    for (std::size_t i = 0; i < piece.triangles.size(); i += 3) {
      std::array<Eigen::Vector3f, 3> p;
      Eigen::Vector3f outward = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = Eigen::Vector3f(piece.triangles[i + k].at.data());
        outward += Eigen::Vector3f(piece.triangles[i + k].outward.data());
      }
      const Eigen::Vector3f normal = (p[1] - p[0]).cross(p[2] - p[0]);
      if (normal.norm() > 1e-4F) {
        EXPECT_GT(normal.dot(outward), 0) << "triangle " << i / 3;
      }
    }
}

TEST(PenMesh, a_pen_without_a_position_is_not_drawn) {
  const stereo::View view;
  Pen pen;
  pen.tip.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(pen_pieces(pen, space_of(view)).empty());
  pen = {};
  pen.shaft = Vec3::Zero();
  EXPECT_TRUE(pen_pieces(pen, space_of(view)).empty());
}

TEST(HandleMesh, a_handle_without_a_position_is_not_drawn) {
  const stereo::View view;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(handle_pieces({Vec3::Constant(nan), Vec3::UnitZ()}, space_of(view)).empty());
  EXPECT_TRUE(handle_pieces({Vec3::Zero(), Vec3::Zero()}, space_of(view)).empty());
  EXPECT_TRUE(handle_pieces({Vec3::Zero(), Vec3::Constant(nan)}, space_of(view)).empty());
  Handle turned{{30, 0, 0}, Vec3::UnitZ(), Handle::Use::arc};
  turned.turn = Handle::Turn{{0, 0, 0}, Vec3::Zero(), 10};
  EXPECT_TRUE(handle_pieces(turned, space_of(view)).empty()) << "no axis";
  turned.turn = Handle::Turn{{0, 0, 0}, Vec3::UnitZ(), nan};
  EXPECT_TRUE(handle_pieces(turned, space_of(view)).empty());
  turned.turn = Handle::Turn{{0, 0, 0}, Vec3::UnitX(), 10};
  EXPECT_EQ(handle_pieces(turned, space_of(view)).size(), 1U) << "a grab on the axis has no arc";
}

TEST_F(EditingMarks, edges_that_follow_the_handle_are_green_and_show_through_the_model) {
  show(two_plates());
  Picture picture = fitted("mono", "top", kMarksWidth, kMarksHeight);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double z : {20.0, -10.0}) {  // before and behind a plate
    picture.followed_edges.clear();
    const Image without = draw(picture, kMarksWidth, kMarksHeight);
    picture.followed_edges = {{Vec3(-5, 3, z), Vec3(0, 3, z)}, {Vec3(0, 3, z), Vec3(5, 3, z)}, {Vec3(0, nan, z), Vec3(5, 3, z)}};
    const Image image = draw(picture, kMarksWidth, kMarksHeight);
    for (const double x : {-4.0, 0.0, 4.0}) {
      const std::uint8_t* pixel = at(image, pixel_of(picture, Vec3(x, 3, z)));
      EXPECT_TRUE(z < 0 || green(pixel)) << x;
      EXPECT_FALSE(std::equal(pixel, pixel + 3, at(without, pixel_of(picture, Vec3(x, 3, z))))) << x << " behind the plate: dimmed";
    }
    const Blob blob = difference(image, without);
    EXPECT_LE(blob.high.y() - blob.low.y(), 8) << "as thin as a line";
  }
}

TEST_F(EditingMarks, a_lasso_is_a_line_in_the_screen_plane_closed_by_dashes) {
  show(two_plates());
  Picture picture = fitted("mono", "iso", kMarksWidth, kMarksHeight);
  const Image without = draw(picture, kMarksWidth, kMarksHeight);
  const std::size_t scenes = renderer_->figures().scenes_drawn;
  picture.lasso = {{40.5, 40.5}, {300.5, 60.5}, {340.5, 300.5}, {60.5, 340.5}};
  const Image image = draw(picture, kMarksWidth, kMarksHeight);
  EXPECT_EQ(renderer_->figures().scenes_drawn, scenes) << "the model isn't drawn again";
  const auto white = [](const Image& drawn, std::size_t from, const Picture& of, int x0, double squeeze) {
    const Eigen::Vector2d a = of.lasso[from], b = of.lasso[(from + 1) % of.lasso.size()];
    int found = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d p = a + (b - a) * (i + 0.5) / 400;
      found += brightness(drawn, x0 + static_cast<int>(p.x() * squeeze), static_cast<int>(p.y())) > 215;
    }
    return found / 400.0;
  };
  for (const std::size_t edge : {0U, 1U, 2U}) EXPECT_GT(white(image, edge, picture, 0, 1), 0.97) << edge;
  // The closing segment, which nobody drew, is dashed: parts of it are white, the rest is the bare picture.
  EXPECT_GT(white(image, 3, picture, 0, 1), 0.2);
  const auto bare_share = [&](std::size_t from) {
    const Eigen::Vector2d a = picture.lasso[from], b = picture.lasso[(from + 1) % 4];
    int found = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d p = a + (b - a) * (i + 0.5) / 400;
      found += std::equal(at(image, p), at(image, p) + 3, at(without, p));
    }
    return found / 400.0;
  };
  EXPECT_EQ(bare_share(1), 0);
  EXPECT_GT(bare_share(3), 0.1);
  EXPECT_LT(bare_share(3), 0.6);
  EXPECT_LT(difference(image, without).pixels, 2U * 4 * 340 * 3) << "a line, and nothing else";
  Picture stereo = fitted("side-by-side", "iso", kMarksWidth, kMarksHeight);
  stereo.lasso = picture.lasso;
  const Image both = draw(stereo, kMarksWidth, kMarksHeight);
  for (const int x0 : {0, kMarksWidth / 2}) EXPECT_GT(white(both, 0, stereo, x0, 0.5), 0.9) << "at the same place for both eyes";
  picture.lasso = {{std::numeric_limits<double>::quiet_NaN(), 3}, {1e300, 4}, {100, 100}};
  EXPECT_EQ(draw(picture, kMarksWidth, kMarksHeight).rgb, without.rgb) << "one corner is no line";
}

/// Bytes that each frame of a drag of the same 100 nodes uploads, on a sheet of n x n quads with many bad shells.
std::vector<std::size_t> bytes_of_frames(Renderer& renderer, const std::function<void()>& draw, std::uint32_t n) {
  auto source = std::make_shared<TestSource>();
  test::add_grid(*source, n, n, 0, [n](double u, double v) { return Vec3(u * n, v * n, 0); });
  for (std::size_t s = 0; s < source->shell_quality.size(); s += 3) source->shell_quality[s].warn = 1;
  source->key = n;
  std::vector<mesh::NodeIndex> nodes;
  std::vector<mesh::ShellIndex> shells;
  for (std::uint32_t j = 0; j < 12; ++j)
    for (std::uint32_t i = 0; i < 12; ++i) {
      if (i < 11 && j < 11) shells.emplace_back((j + 5) * n + i + 5);
      if (i >= 1 && i <= 10 && j >= 1 && j <= 10) nodes.emplace_back((j + 5) * (n + 1) + i + 5);
    }
  for (const mesh::NodeIndex node : nodes) source->node_marks[node.value] = mesh::document::kSelected;
  EXPECT_TRUE(renderer.set_model(source));
  draw();
  renderer.begin_preview(nodes, shells);
  std::vector<std::size_t> bytes;
  std::size_t before = renderer.figures().bytes_uploaded;
  for (int frame_number = 0; frame_number < 4; ++frame_number) {
    ipc::PreviewFrame frame;
    for (const mesh::NodeIndex node : nodes) frame.positions.push_back(source->positions[node.value] + Vec3(0, 0, 1 + frame_number));
    frame.states.resize(shells.size());
    for (int i = 0; i < 7; ++i) frame.states[static_cast<std::size_t>(i * 9)].fail = 1;
    EXPECT_TRUE(renderer.update_preview(frame));
    draw();
    bytes.push_back(renderer.figures().bytes_uploaded - before);
    before = renderer.figures().bytes_uploaded;
  }
  renderer.end_preview();
  return bytes;
}

TEST_F(EditingMarks, a_frame_of_a_drag_uploads_only_the_moving_patch) {
  Picture picture;
  picture.profile = *stereo::find_profile("mono");
  const auto draw_it = [&] { draw(picture, 64, 40); };
  const std::vector<std::size_t> small = bytes_of_frames(*renderer_, draw_it, 40);
  const std::vector<std::size_t> large = bytes_of_frames(*renderer_, draw_it, 400);
  for (std::size_t i = 1; i < small.size(); ++i) {
    EXPECT_EQ(small[i], 12U * 12 * 16 + 7 * 8) << "positions of the shells' corners, and the patch's glyphs";
    EXPECT_EQ(large[i], small[i]);
  }
}

}  // namespace
}  // namespace prismesh::kiosk::render
