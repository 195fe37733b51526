// Drawing a model, picking under the pointer, and both with hostile snapshots.
#include <algorithm>
#include <cmath>
#include <limits>

#include <GLES3/gl31.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/render/glyph_shape.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using ipc::SnapshotArray;
using mesh::Vec3;
using test::TestSource;
using test::two_plates;

constexpr int kSceneWidth = 320, kSceneHeight = 200;

class Scene : public RenderTest {
 protected:
  Eigen::Vector2d pixel_of(const Picture& picture, const Vec3& point) const {
    return *stereo::pixel_of(aim_of(picture, kSceneWidth, kSceneHeight), point);
  }
  static Vec3 centre(const TestSource& source, std::size_t shell) {
    Vec3 sum = Vec3::Zero();
    for (const mesh::NodeIndex node : source.shell_nodes[shell].node) sum += source.positions[node.value];
    return sum / 4;
  }
  const std::uint8_t* at(const Image& image, const Eigen::Vector2d& pixel) const {
    return image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }
};

TEST_F(Scene, hidden_parts_are_neither_drawn_nor_picked) {
  TestSource source = two_plates();
  show(source);
  const Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  const Eigen::Vector2d pixel = pixel_of(picture, centre(source, 44));
  const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
  EXPECT_EQ(renderer_->shell_at(aim, pixel), mesh::ShellIndex(44));
  const Image both = draw(picture, kSceneWidth, kSceneHeight);
  source.hidden[0] = true;
  show(source);
  const auto behind = renderer_->shell_at(aim, pixel);
  ASSERT_TRUE(behind);
  EXPECT_GE(behind->value, 100U) << "the plate behind is visible";
  const Image one = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_NE(both.rgb, one.rgb);
  source.hidden[1] = true;
  show(source);
  EXPECT_FALSE(renderer_->shell_at(aim, pixel));
  EXPECT_TRUE(renderer_->bounds().empty());
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, [&] {
    EXPECT_TRUE(renderer_->set_model(nullptr));
    return draw(picture, kSceneWidth, kSceneHeight).rgb;
  }()) << "the picture is empty";
}

TEST_F(Scene, transparent_parts_mix_with_what_is_behind_and_picks_go_through_them) {
  const TestSource source = two_plates();
  show(source);
  for (const char* profile : {"mono", "prism-mask"}) {
    Picture picture = fitted(profile, "top", kSceneWidth, kSceneHeight);
    picture.element_edges = picture.outlines = picture.quality_glyphs = false;
    const Eigen::Vector2d pixel = pixel_of(picture, centre(source, 44));
    const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
    const auto drawn = [&](bool front, bool transparent) {
      TestSource shown = source;
      shown.hidden[0] = !front;
      show(shown);
      const std::array<PartPaint, 1> paints{{{std::nullopt, transparent}}};
      EXPECT_TRUE(renderer_->set_part_paints(paints));
      const Image image = draw(picture, kSceneWidth, kSceneHeight);
      return Eigen::Vector3d(at(image, pixel)[0], at(image, pixel)[1], at(image, pixel)[2]);
    };
    const Eigen::Vector3d front = drawn(true, false), behind = drawn(false, false), mixed = drawn(true, true);
    EXPECT_GT((front - behind).norm(), 20) << profile;
    EXPECT_LE((mixed - (0.3 * front + 0.7 * behind)).cwiseAbs().maxCoeff(), 1.5) << profile << ": " << mixed.transpose();
    const auto picked = renderer_->shell_at(aim, pixel);
    ASSERT_TRUE(picked);
    EXPECT_GE(picked->value, 100U) << profile << ": the plate behind";
    const auto node = renderer_->node_near(aim, pixel, 16);
    ASSERT_TRUE(node);
    EXPECT_GE(node->value, 121U) << profile;
    ASSERT_TRUE(renderer_->set_part_paints({}));
    EXPECT_EQ(renderer_->shell_at(aim, pixel), mesh::ShellIndex(44)) << profile << ": the picks follow at once";
  }
}

TEST_F(Scene, a_part_has_the_colour_chosen_for_it_while_parts_have_colours) {
  show(two_plates());
  Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  picture.element_edges = picture.outlines = picture.quality_glyphs = false;
  const Eigen::Vector2d pixel = pixel_of(picture, centre(two_plates(), 44));
  const auto hue = [&] {
    const Image image = draw(picture, kSceneWidth, kSceneHeight);
    const Eigen::Vector3d rgb(at(image, pixel)[0], at(image, pixel)[1], at(image, pixel)[2]);
    return Eigen::Vector3d(rgb / rgb.maxCoeff());
  };
  const Eigen::Vector3d own = hue();
  const std::array<PartPaint, 1> paints{{{Colour(0.2F, 0.4F, 0.8F), false}}};
  ASSERT_TRUE(renderer_->set_part_paints(paints));
  EXPECT_LE((hue() - Eigen::Vector3d(0.25, 0.5, 1)).cwiseAbs().maxCoeff(), 0.02) << "lit as every part, so the hue stays";
  picture.colour = ColourMode::quality;
  const Eigen::Vector3d passes = hue();
  ASSERT_TRUE(renderer_->set_part_paints({}));
  EXPECT_EQ(hue(), passes) << "grades keep their colours";
  picture.colour = ColourMode::parts;
  EXPECT_EQ(hue(), own);
}

TEST_F(Scene, picking_finds_what_is_visible) {
  const TestSource source = two_plates();
  show(source);
  for (const char* profile : {"mono", "prism-mask"}) {
    const Picture picture = fitted(profile, "top", kSceneWidth, kSceneHeight);
    const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
    for (const std::size_t shell : {0U, 37U, 99U})
      EXPECT_EQ(renderer_->shell_at(aim, pixel_of(picture, centre(source, shell))), mesh::ShellIndex(shell)) << profile;
    const Eigen::Vector2d at_node = pixel_of(picture, source.positions[60]);
    EXPECT_EQ(renderer_->node_near(aim, at_node + Eigen::Vector2d(2, -3), 6), mesh::NodeIndex(60)) << profile;
    EXPECT_FALSE(renderer_->node_near(aim, {1, 1}, 5)) << profile;
    EXPECT_FALSE(renderer_->shell_at(aim, {-5, 1e9})) << profile;
  }
}

TEST_F(Scene, a_pick_on_nearly_coincident_sheets_takes_the_visible_one) {
  // The edge of a flange: the sheet beneath extends beyond it and has nodes 0.01 below it.
  TestSource source;
  test::add_grid(source, 5, 10, 0, [](double u, double v) { return Vec3(u * 50 - 50, v * 60 - 30, 0); });
  const std::uint32_t beneath =
      test::add_grid(source, 20, 20, 1, [](double u, double v) { return Vec3(u * 100 - 53, v * 60 - 30, -0.01); });
  show(source);
  const Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
  constexpr double kRadius = 16;
  std::size_t tried = 0;
  for (std::uint32_t node = beneath; node < source.positions.size(); ++node) {
    if (const double x = source.positions[node].x(); x < -4 || x > 0) continue;
    const Eigen::Vector2d at = pixel_of(picture, source.positions[node]);
    const auto shell = renderer_->shell_at(aim, at);
    if (!shell || shell->value >= 50) continue;
    const auto picked = renderer_->node_near(aim, at, kRadius);
    ASSERT_TRUE(picked);
    EXPECT_LT(picked->value, beneath) << "the upper sheet lies under the pointer";
    ++tried;
  }
  EXPECT_GT(tried, 10U);
}

TEST_F(Scene, the_end_of_a_line_in_front_of_a_plate_is_picked) {
  TestSource source = two_plates();
  const std::uint32_t from = source.add_node({2, 1, 30}), to = source.add_node({7, 4, 30});
  source.add_line(from, to, 2);
  show(source);
  const Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  EXPECT_EQ(renderer_->node_near(aim_of(picture, kSceneWidth, kSceneHeight), pixel_of(picture, source.positions[to]), 16),
            mesh::NodeIndex(to));
}

TEST_F(Scene, a_rectangle_takes_visible_nodes_or_all) {
  const TestSource source = two_plates();
  show(source);
  const Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
  const Eigen::Vector2d a = pixel_of(picture, source.positions[12]), b = pixel_of(picture, source.positions[108]);
  const PixelRect rect{a.x() - 1, a.y() + 1, b.x() + 1, b.y() - 1};  // the front plate's inner nodes
  const mesh::NodeSet seen = renderer_->nodes_in(aim, rect, false);
  EXPECT_EQ(seen.size(), 81U);
  for (const mesh::NodeIndex node : seen) EXPECT_LT(node.value, 121U);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  const mesh::NodeSet through = renderer_->nodes_in(aim, rect, true);
  EXPECT_GT(through.size(), 81U + 80U);
  EXPECT_EQ(renderer_->figures().item_buffers_drawn, 1U) << "drawn once for each view";
  renderer_->shell_at(aim, a);
  EXPECT_EQ(renderer_->figures().item_buffers_drawn, 1U);
  show(source);
  renderer_->shell_at(aim, a);
  EXPECT_EQ(renderer_->figures().item_buffers_drawn, 2U);
}

TEST_F(Scene, nodes_of_tiny_elements_count_as_visible) {
  TestSource source;
  test::add_grid(source, 400, 250, 0,
                 [](double u, double v) { return Vec3(u * 100 - 50, v * 60 - 30, 8 * std::sin(u * 6) * std::cos(v * 4)); });
  show(source);
  const auto aim = aim_of(fitted("mono", "top", kSceneWidth, kSceneHeight), kSceneWidth, kSceneHeight);
  const mesh::NodeSet seen = renderer_->nodes_in(aim, {0, 0, kSceneWidth, kSceneHeight}, false);
  EXPECT_GT(seen.size(), source.positions.size() * 99 / 100) << "elements smaller than a pixel hide nothing";
}

TEST_F(Scene, beams_are_picked) {
  TestSource source;
  const std::uint32_t left = source.add_node({-10, 0, 0}), right = source.add_node({10, 0, 0});
  source.add_line(left, right, 0);
  show(source);
  const Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  EXPECT_EQ(renderer_->node_near(aim_of(picture, kSceneWidth, kSceneHeight), pixel_of(picture, {10, 0, 0}), 5), mesh::NodeIndex(1));
  source.hidden[0] = true;
  show(source);
  EXPECT_FALSE(renderer_->node_near(aim_of(picture, kSceneWidth, kSceneHeight), pixel_of(picture, {10, 0, 0}), 5));
}

TEST_F(Scene, selected_nodes_are_white_and_show_through) {
  TestSource source = two_plates();
  source.node_marks[60] = mesh::document::kSelected;        // front
  source.node_marks[121 + 37] = mesh::document::kSelected;  // behind the front plate
  show(source);
  Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  picture.element_edges = false;
  const Image image = draw(picture, kSceneWidth, kSceneHeight);
  const std::uint8_t* front = at(image, pixel_of(picture, source.positions[60]));
  EXPECT_GT(std::min({front[0], front[1], front[2]}), 205);
  EXPECT_NEAR(front[0], front[2], 1);
  const std::uint8_t* hidden = at(image, pixel_of(picture, source.positions[121 + 37]));
  picture.selected_nodes = false;
  const Image without = draw(picture, kSceneWidth, kSceneHeight);
  const std::uint8_t* plain = at(without, pixel_of(picture, source.positions[121 + 37]));
  EXPECT_GT(hidden[2], plain[2] + 20) << "shows through";
  EXPECT_LT(hidden[2], front[2]) << "but dimmed";
  source.hidden[1] = true;
  show(source);
  picture.selected_nodes = true;
  const Image hidden_part = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_EQ(at(hidden_part, pixel_of(picture, source.positions[121 + 37]))[2], plain[2]) << "nodes of hidden parts don't show";
}

TEST_F(Scene, quality_has_its_colours_and_glyphs) {
  TestSource source = two_plates();
  source.shell_quality[44].fail = source.shell_quality[44].warn = 1;  // warpage: its glyph crosses the middle
  source.shell_quality[46].warn = 2;
  show(source);
  Picture picture = fitted("mono", "top", kSceneWidth, kSceneHeight);
  picture.colour = ColourMode::quality;
  picture.quality_glyphs = false;
  Image image = draw(picture, kSceneWidth, kSceneHeight);
  const std::uint8_t* fail = at(image, pixel_of(picture, centre(source, 44)));
  const std::uint8_t* warn = at(image, pixel_of(picture, centre(source, 46)));
  const std::uint8_t* ok = at(image, pixel_of(picture, centre(source, 48)));
  EXPECT_GT(fail[0], 2 * fail[1]) << "red";
  EXPECT_GT(warn[1], 2 * warn[2]) << "yellow";
  EXPECT_NEAR(ok[0], ok[2], 12) << "grey";
  picture.colour = ColourMode::parts;
  picture.quality_glyphs = true;
  image = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_EQ(report_.glyphs, 2U);
  const std::uint8_t* glyph = at(image, pixel_of(picture, centre(source, 44)));
  EXPECT_GT(glyph[0], 2 * glyph[1]) << "a red glyph";
}

TEST_F(Scene, a_preview_is_a_white_wireframe_with_its_own_glyphs) {
  TestSource source = two_plates();
  source.shell_quality[0].warn = 1;
  source.shell_quality[44].warn = 1;
  show(source);
  Picture picture = fitted("mono", "front", kSceneWidth, kSceneHeight);
  const Image before = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_EQ(report_.glyphs, 2U);
  const std::vector<mesh::NodeIndex> nodes{mesh::NodeIndex(60)};
  const std::vector<mesh::ShellIndex> shells{mesh::ShellIndex(44), mesh::ShellIndex(45), mesh::ShellIndex(54), mesh::ShellIndex(55)};
  renderer_->begin_preview(nodes, shells);
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, before.rgb) << "no frame yet";
  ipc::PreviewFrame frame;
  const Vec3 lifted = source.positions[60] + Vec3(0, 0, 10);
  frame.positions = {lifted};
  frame.states.resize(4);
  frame.states[1].fail = frame.states[1].warn = 2;
  frame.states[2].fail = frame.states[2].warn = 2;
  ASSERT_TRUE(renderer_->update_preview(frame));
  const Image during = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_EQ(report_.glyphs, 3U) << "two of the preview, and the untouched shell's";
  const std::uint8_t* tip = at(during, pixel_of(picture, lifted) + Eigen::Vector2d(0, 2));
  EXPECT_GT(std::min({tip[0], tip[1], tip[2]}), 180);
  frame.positions.clear();
  ASSERT_TRUE(renderer_->update_preview(frame)) << "a frame of another size is ignored";
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, during.rgb);
  renderer_->end_preview();
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, before.rgb);
}

TEST_F(Scene, a_preview_draws_all_glyphs_of_shells_that_fail_every_metric) {
  const TestSource source = two_plates();
  show(source);
  const std::vector<mesh::NodeIndex> nodes{mesh::NodeIndex(60)};
  const std::vector<mesh::ShellIndex> shells{mesh::ShellIndex(44), mesh::ShellIndex(45), mesh::ShellIndex(54), mesh::ShellIndex(55)};
  renderer_->begin_preview(nodes, shells);
  ipc::PreviewFrame frame;
  frame.positions = {source.positions[60] + Vec3(0, 0, 60)};
  frame.states.resize(4);
  for (auto& state : frame.states) state.warn = state.fail = static_cast<std::uint16_t>((1U << mesh::quality::kMetricCount) - 1);
  ASSERT_TRUE(renderer_->update_preview(frame));
  draw(fitted("mono", "front", kSceneWidth, kSceneHeight), kSceneWidth, kSceneHeight);
  EXPECT_EQ(report_.glyphs, 4 * kMaxShapesOfShell);
  EXPECT_EQ(report_.glyphs_left_out, 0U);
}

TEST_F(Scene, the_active_handle_is_green) {
  show(two_plates());
  Picture picture = fitted("mono", "front", kSceneWidth, kSceneHeight);
  const Vec3 foot(0, -30, 20);
  const Vec3 down = -Vec3::UnitZ();
  picture.handle = Handle{foot, down, Handle::Use::arrow};
  const Eigen::Vector2d middle =
      pixel_of(picture, stereo::handle_tip(aim_of(picture, kSceneWidth, kSceneHeight), foot, down)) - Eigen::Vector2d(0, 12);
  const Image image = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_GT(at(image, middle)[1], at(image, middle)[0] * 3 / 2);
  picture.handle->use = Handle::Use::idle;
  const Image idle = draw(picture, kSceneWidth, kSceneHeight);
  EXPECT_NEAR(at(idle, middle)[1], at(idle, middle)[0], 3);
  picture.handle->direction = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  draw(picture, kSceneWidth, kSceneHeight);
}

TEST_F(Scene, the_model_is_drawn_again_only_for_another_scene) {
  make_renderer({.samples = 4});
  TestSource source = two_plates();
  show(source);
  for (const char* profile : {"mono", "prism-mask"}) {
    Picture picture = fitted(profile, "iso", kSceneWidth, kSceneHeight);
    const auto drawn = [&] { return renderer_->figures().scenes_drawn; };
    const Image plain = draw(picture, kSceneWidth, kSceneHeight);
    const std::size_t before = drawn();
    picture.rubber_band = PixelRect{40, 30, 200, 150};
    // An overlay may leave any state.
    picture.overlay = [](const EyeImage& image) {
      glEnable(GL_SCISSOR_TEST);
      glScissor(0, 0, image.width / 2, image.height / 2);
      glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
      glClearColor(0.2F, 0.4F, 0.6F, 1);
      glClear(GL_COLOR_BUFFER_BIT);
    };
    const Image covered = draw(picture, kSceneWidth, kSceneHeight);
    EXPECT_NE(covered.rgb, plain.rgb);
    EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, covered.rgb) << profile << ": overlays don't accumulate";
    picture.rubber_band.reset();
    picture.overlay = nullptr;
    picture.moving = true;
    EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, plain.rgb) << profile << ": nothing of the overlay stays";
    EXPECT_EQ(drawn(), before) << profile;
    picture.moving = false;

    picture.view = stereo::orbit(picture.view, 0.1, 0);
    EXPECT_NE(draw(picture, kSceneWidth, kSceneHeight).rgb, plain.rgb) << profile;
    picture.handle = Handle{};
    draw(picture, kSceneWidth, kSceneHeight);
    picture.colour = ColourMode::quality;
    draw(picture, kSceneWidth, kSceneHeight);
    show(source);
    draw(picture, kSceneWidth, kSceneHeight);
    EXPECT_EQ(drawn(), before + 4) << profile;
  }
}

TEST_F(Scene, a_moving_picture_is_coarse_and_a_resting_one_unchanged_afterwards) {
  make_renderer({.samples = 4});
  show(two_plates());
  Picture picture = fitted("mono", "iso", kSceneWidth, kSceneHeight);
  const Image rest = draw(picture, kSceneWidth, kSceneHeight);
  const stereo::View view = picture.view;
  picture.view = stereo::orbit(view, 0.3, 0.1);
  draw(picture, kSceneWidth, kSceneHeight);
  picture.view = view;
  picture.moving = true;
  EXPECT_NE(draw(picture, kSceneWidth, kSceneHeight).rgb, rest.rgb) << "edges are not smooth while it moves";
  picture.moving = false;
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, rest.rgb);
}

TEST_F(Scene, only_what_changed_is_uploaded) {
  auto source = std::make_shared<TestSource>();
  test::add_grid(*source, 200, 200, 0, [](double u, double v) { return Vec3(u, v, 0); });
  show(source);
  const std::size_t all = renderer_->figures().chunks_uploaded;
  EXPECT_GE(all, 10U + 2 * 10U);
  show(std::make_shared<TestSource>(*source));
  EXPECT_EQ(renderer_->figures().chunks_uploaded, all) << "the same chunks again";
  source->positions[0].z() = 0.1;
  source->touch(SnapshotArray::positions, 0);
  show(source);
  const std::size_t moved = renderer_->figures().chunks_uploaded - all;
  EXPECT_GE(moved, 1U);
  EXPECT_LE(moved, 1U + 2 * 2U) << "one row of positions, and the rows of the shells on it";
}

TEST_F(Scene, the_picture_after_a_change_equals_that_of_a_new_renderer) {
  auto source = std::make_shared<TestSource>(test::make_crash_box());
  show(source);
  const Picture picture = fitted("prism-mask", "iso", kSceneWidth, kSceneHeight);
  draw(picture, kSceneWidth, kSceneHeight);
  for (std::size_t n = 100; n < 140; ++n) source->positions[n].z() += 9, source->node_marks[n] = 1;
  source->touch(SnapshotArray::positions, 0);
  source->touch(SnapshotArray::node_marks, 0);
  show(source);
  const Image followed = draw(picture, kSceneWidth, kSceneHeight);
  make_renderer({.samples = 1});
  show(source);
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, followed.rgb);
  EXPECT_EQ(draw(picture, kSceneWidth, kSceneHeight).rgb, followed.rgb) << "and again, bit for bit";
}

TEST_F(Scene, far_from_the_origin_the_picture_keeps_its_precision) {
  TestSource near_source = test::make_crash_box(), far_source = near_source;
  for (Vec3& at : far_source.positions) at += Vec3(4e6, -7e6, 1e6);
  far_source.key = 2;
  show(near_source);
  const Image near_image = draw(fitted("mono", "iso", kSceneWidth, kSceneHeight), kSceneWidth, kSceneHeight);
  show(far_source);
  const Image far_image = draw(fitted("mono", "iso", kSceneWidth, kSceneHeight), kSceneWidth, kSceneHeight);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < near_image.rgb.size(); ++i) differ += std::abs(near_image.rgb[i] - far_image.rgb[i]) > 24;
  EXPECT_LT(differ, near_image.rgb.size() / 200);
}

TEST_F(Scene, a_hostile_snapshot_is_drawn_without_a_crash) {
  TestSource source = test::make_crash_box();
  source.shell_nodes[3].node[1] = mesh::NodeIndex(4000000000U);
  source.shell_nodes[4].node = {};
  source.shell_parts[5] = mesh::PartIndex(4000000000U);
  source.line_nodes[0] = mesh::NodeIndex(123456789U);
  source.line_parts.resize(2);
  source.positions[50] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  source.positions[51] = Vec3(1e300, 0, 0);
  source.positions[52] = Vec3::Constant(std::numeric_limits<double>::infinity());
  source.shell_quality.resize(100);
  for (auto& state : source.shell_quality) state.fail = state.warn = 0xffff;
  source.shell_marks.clear();
  source.node_marks.resize(source.positions.size() + 5000, 255);
  source.shell_parts.resize(source.shell_nodes.size() - 10);
  show(source);
  Picture picture = fitted("prism-mask", "iso", kSceneWidth, kSceneHeight);
  EXPECT_TRUE(std::isfinite(picture.view.mm_per_unit));
  draw(picture, kSceneWidth, kSceneHeight);
  const auto aim = aim_of(picture, kSceneWidth, kSceneHeight);
  renderer_->shell_at(aim, {100, 100});
  renderer_->node_near(aim, {100, 100}, 50);
  renderer_->nodes_in(aim, {0, 0, kSceneWidth, kSceneHeight}, false);
  renderer_->begin_preview(std::array{mesh::NodeIndex(9999999)}, std::array{mesh::ShellIndex(9999999), mesh::ShellIndex(3)});
  source.positions.resize(10);  // shells of the next snapshot use nodes that it doesn't have
  source.touch(SnapshotArray::positions, 0);
  show(source);
  draw(picture, kSceneWidth, kSceneHeight);
}

}  // namespace
}  // namespace prismesh::kiosk::render
