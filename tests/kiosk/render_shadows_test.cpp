// Planes of the shadows, the plane under the pointer, and the shadows of what is dragged or selected.
#include "kiosk/render/shadows.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using test::TestSource;

constexpr int kShadowsWidth = 640, kShadowsHeight = 400;

stereo::Box box_of(const Vec3& low, const Vec3& high) {
  stereo::Box box;
  box.add(low);
  box.add(high);
  return box;
}

stereo::View view_from(const std::string& name, const stereo::Box& box) {
  stereo::View view;
  view.rotation = *stereo::named_rotation(name);
  view.bounds = stereo::sphere_around(box);
  return stereo::fit(view, box, {448, 280});
}

TEST(ShadowPlanes, are_on_the_sides_turned_away_from_the_viewer) {
  const stereo::Box box = box_of({-50, -30, -20}, {50, 30, 20});
  const auto planes = shadow_planes(box, view_from("iso", box));  // seen from the right (+x), the front (-y) and above (+z)
  ASSERT_EQ(planes.size(), 3U);
  EXPECT_LT(planes[0].low.x(), -50);
  EXPECT_GT(planes[1].low.y(), 30);
  EXPECT_LT(planes[2].low.z(), -20);
  for (const ShadowPlane& plane : planes) {
    EXPECT_EQ(plane.low[plane.axis], plane.high[plane.axis]);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == plane.axis) continue;
      EXPECT_LT(plane.low[axis], box.low[axis]);
      EXPECT_GT(plane.high[axis], box.high[axis]);
    }
  }
}

TEST(ShadowPlanes, a_plane_seen_edge_on_is_left_out) {
  const stereo::Box box = box_of({-50, -30, -20}, {50, 30, 20});
  const auto planes = shadow_planes(box, view_from("top", box));
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].axis, 2);
  EXPECT_TRUE(shadow_planes(stereo::Box(), view_from("iso", box)).empty());
}

TEST(ShadowPlanes, the_pointer_finds_the_point_that_it_sees) {
  const stereo::Box box = box_of({-50, -30, -20}, {50, 30, 20});
  stereo::Aim aim;
  aim.view = view_from("iso", box);
  aim.screen_mm = {448, 280};
  aim.width = kShadowsWidth;
  aim.height = kShadowsHeight;
  for (const ShadowPlane& plane : shadow_planes(box, aim.view))
    for (const double u : {0.1, 0.5, 0.9}) {
      Vec3 point = plane.low + u * (plane.high - plane.low);
      point[(plane.axis + 1) % 3] = plane.low[(plane.axis + 1) % 3] + 0.6 * (plane.high - plane.low)[(plane.axis + 1) % 3];
      const auto found = shadow_plane_at(aim, box, *stereo::pixel_of(aim, point));
      ASSERT_TRUE(found);
      EXPECT_EQ(found->plane.axis, plane.axis);
      EXPECT_LT((found->at - point).norm(), 1e-6);
    }
  EXPECT_FALSE(shadow_plane_at(aim, box, {2, 2})) << "beside all planes";
}

class Shadows : public RenderTest {
 protected:
  /// A plate with a raised middle, and shadows seen from the front.
  void SetUp() override {
    RenderTest::SetUp();
    if (IsSkipped()) return;
    test::add_grid(source_, 10, 10, 0, [](double u, double v) { return Vec3(u * 100 - 50, v * 60 - 30, 0); });
    test::add_grid(source_, 1, 1, 1, [](double u, double v) { return Vec3(u * 10 - 5, 28, v * 40); });
    show(source_);
    picture_ = fitted("mono", "iso", kShadowsWidth, kShadowsHeight);
    picture_.shadows = true;
  }
  /// Brightness of the back plane near a point of it that the model doesn't cover.
  int light_at_back(const Image& image, double x, double z) const {
    for (const ShadowPlane& plane : shadow_planes(renderer_->bounds(), picture_.view))
      if (plane.axis == 1) {
        const Eigen::Vector2d pixel = *stereo::pixel_of(aim_of(picture_, kShadowsWidth, kShadowsHeight), Vec3(x, plane.low.y(), z));
        return brightness(image, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      }
    return -1;
  }
  TestSource source_;
  Picture picture_;
};

TEST_F(Shadows, are_on_the_plane_behind_what_is_dragged) {
  const Image none = draw(picture_, kShadowsWidth, kShadowsHeight);
  picture_.shadows = false;
  EXPECT_EQ(draw(picture_, kShadowsWidth, kShadowsHeight).rgb, none.rgb) << "nothing is selected or dragged";
  picture_.shadows = true;
  std::vector<mesh::NodeIndex> nodes;
  std::vector<mesh::ShellIndex> shells{mesh::ShellIndex(44), mesh::ShellIndex(45)};
  ipc::PreviewFrame frame;
  for (const std::size_t shell : {44U, 45U})
    for (const mesh::NodeIndex node : source_.shell_nodes[shell].node)
      if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  // A vertical strip from 15 to 35 high, which casts a shadow 20 wide.
  for (const mesh::NodeIndex node : nodes) {
    const Vec3& at = source_.positions[node.value];
    frame.positions.push_back(Vec3(at.x(), 0, 15 + (at.y() > -3 ? 20 : 0)));
  }
  frame.states.resize(shells.size());
  renderer_->begin_preview(nodes, shells);
  ASSERT_TRUE(renderer_->update_preview(frame));
  const Image dragged = draw(picture_, kShadowsWidth, kShadowsHeight);
  const double x0 = frame.positions.front().x();
  EXPECT_LT(light_at_back(dragged, x0 + 15, 30), light_at_back(none, x0 + 15, 30) - 20);
  for (Vec3& at : frame.positions) at.x() -= 40;
  ASSERT_TRUE(renderer_->update_preview(frame));
  const Image moved = draw(picture_, kShadowsWidth, kShadowsHeight);
  EXPECT_NEAR(light_at_back(moved, x0 + 15, 30), light_at_back(none, x0 + 15, 30), 16) << "it moves with the surface";
  EXPECT_LT(light_at_back(moved, x0 - 25, 30), light_at_back(none, x0 - 25, 30) - 20);
}

TEST_F(Shadows, are_of_the_selection_while_nothing_is_dragged) {
  const Image none = draw(picture_, kShadowsWidth, kShadowsHeight);
  for (std::size_t n = 121; n < 125; ++n) source_.node_marks[n] = mesh::document::kSelected;
  source_.key = 2;
  show(source_);
  const Image image = draw(picture_, kShadowsWidth, kShadowsHeight);
  EXPECT_LT(light_at_back(image, 0, 36), light_at_back(none, 0, 36) - 20);
  source_.hidden[1] = true;
  show(source_);
  picture_.shadows = false;
  const Image plain = draw(picture_, kShadowsWidth, kShadowsHeight);
  picture_.shadows = true;
  EXPECT_EQ(draw(picture_, kShadowsWidth, kShadowsHeight).rgb, plain.rgb) << "hidden shells cast no shadow";
}

}  // namespace
}  // namespace prismesh::kiosk::render
