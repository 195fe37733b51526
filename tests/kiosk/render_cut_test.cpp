// A model that is cut open: what is above the plane is neither drawn nor picked, and the curves of the cut are drawn.
#include <cmath>

#include <gtest/gtest.h>

#include "kiosk/render/model_copy.h"
#include "mesh/select/visible.h"
#include "tests/kiosk/render_test.h"
#include "tests/support/make_model.h"

namespace prismesh::kiosk::render {
namespace {

using mesh::Vec3;
using test::TestSource;
using test::two_plates;

constexpr int kCutWidth = 320, kCutHeight = 200;

class CutPictures : public RenderTest {
 protected:
  void SetUp() override {
    RenderTest::SetUp();
    if (IsSkipped()) return;
    if (!Renderer::can_cut()) GTEST_SKIP() << "CUT PICTURES ARE NOT TESTED: the driver has no GL_EXT_clip_cull_distance";
    show(two_plates());
    picture_ = fitted("mono", "top", kCutWidth, kCutHeight);
    picture_.element_edges = false;
  }
  void cut(const Vec3& point, const Vec3& normal, std::vector<std::array<Vec3, 2>> segments = {}) {
    const auto done = renderer_->set_cut(CutPicture{point, normal, std::move(segments)});
    ASSERT_TRUE(done) << done.error().text();
  }
  stereo::Aim aim() const { return aim_of(picture_, kCutWidth, kCutHeight); }
  Eigen::Vector2d pixel_of(const Vec3& point) const { return *stereo::pixel_of(aim(), point); }
  std::optional<mesh::ShellIndex> picked(const Vec3& at) { return renderer_->shell_at(aim(), pixel_of(at)); }

  Picture picture_;
};

TEST_F(CutPictures, what_is_above_the_plane_is_gone) {
  const Image whole = draw(picture_, kCutWidth, kCutHeight);
  cut({5, 0, 0}, Vec3::UnitX());
  const Image half = draw(picture_, kCutWidth, kCutHeight);
  const auto brightness_at = [&](const Image& image, const Vec3& at) {
    const Eigen::Vector2d pixel = pixel_of(at);
    return brightness(image, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  const Image ground = [&] {
    show(std::shared_ptr<TestSource>());
    const Image empty = draw(picture_, kCutWidth, kCutHeight);
    show(two_plates());
    return empty;
  }();
  EXPECT_EQ(brightness_at(half, {-30, 3, 20}), brightness_at(whole, {-30, 3, 20}));
  EXPECT_EQ(brightness_at(half, {30, 3, 20}), brightness_at(ground, {30, 3, 20}));
  EXPECT_NE(brightness_at(whole, {30, 3, 20}), brightness_at(ground, {30, 3, 20}));
  // A shell that the plane goes through is cut, not left out: it reaches from 0 to 10.
  EXPECT_EQ(brightness_at(half, {3, 3, 20}), brightness_at(whole, {3, 3, 20}));
  EXPECT_EQ(brightness_at(half, {7.5, 3, 20}), brightness_at(ground, {7.5, 3, 20}));
  ASSERT_TRUE(renderer_->set_cut(std::nullopt));
  const Image again = draw(picture_, kCutWidth, kCutHeight);
  for (int y = 0; y < kCutHeight; ++y)
    for (int x = 0; x < kCutWidth; ++x) ASSERT_EQ(brightness(again, x, y), brightness(whole, x, y)) << x << ", " << y;
}

TEST_F(CutPictures, picks_go_through_to_what_is_left) {
  EXPECT_LT(picked({2, 3, 20})->value, 100U) << "the front plate";
  cut({0, 0, 0}, Vec3::UnitZ());  // takes the front plate away
  ASSERT_TRUE(picked({2, 3, -20}));
  EXPECT_GE(picked({2, 3, -20})->value, 100U);
  const auto node = renderer_->node_near(aim(), pixel_of({0, 0, -20}), 16);
  ASSERT_TRUE(node);
  EXPECT_GE(node->value, 121U);
  for (const mesh::NodeIndex each : renderer_->nodes_in(aim(), {0, 0, kCutWidth, kCutHeight}, false)) EXPECT_GE(each.value, 121U);
  cut({5, 0, 0}, Vec3::UnitX());
  EXPECT_TRUE(picked({2, 3, 20}));
  EXPECT_FALSE(picked({30, 3, 20}));
  EXPECT_FALSE(renderer_->node_near(aim(), pixel_of({30, 0, 20}), 6));
}

TEST_F(CutPictures, the_curves_are_drawn_on_the_cut_itself) {
  cut({5, 0, 0}, Vec3::UnitX());
  const Image without = draw(picture_, kCutWidth, kCutHeight);
  cut({5, 0, 0}, Vec3::UnitX(), {{Vec3(5, -30, 20), Vec3(5, 30, 20)}});
  const Image with = draw(picture_, kCutWidth, kCutHeight);
  const Eigen::Vector2d at = pixel_of({5, 3, 20});
  const std::uint8_t* line = with.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
  EXPECT_GT(int{line[2]}, line[0] + 60) << "blue";
  const std::uint8_t* before = without.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
  EXPECT_LT(int{before[2]}, before[0] + 60);
}

TEST_F(CutPictures, each_of_two_views_has_the_curves_of_its_model) {
  ASSERT_TRUE(renderer_->set_other(std::make_shared<TestSource>(two_plates())));
  picture_.two_views = TwoViews{};
  picture_.view = stereo::zoom(picture_.view, 0.5, {0, 0});
  const auto blue_in = [&](bool right) {
    const Image image = draw(picture_, kCutWidth, kCutHeight);
    int blue = 0;
    for (int y = 0; y < kCutHeight; ++y)
      for (int x = right ? kCutWidth / 2 : 0; x < (right ? kCutWidth : kCutWidth / 2); ++x)
        blue += image.at(x, y)[2] > image.at(x, y)[0] + 60 ? 1 : 0;
    return blue;
  };
  const std::vector<std::array<Vec3, 2>> curve{{Vec3(5, -30, 20), Vec3(5, 30, 20)}};
  cut({5, 0, 0}, Vec3::UnitX());
  const int right = blue_in(true), left = blue_in(false);  // what is seen of the blue part
  cut({5, 0, 0}, Vec3::UnitX(), curve);
  EXPECT_GT(blue_in(true), right + 20);
  EXPECT_EQ(blue_in(false), left);
  ASSERT_TRUE(renderer_->set_cut(CutPicture{{5, 0, 0}, Vec3::UnitX(), {}, curve}));
  EXPECT_EQ(blue_in(true), right);
  EXPECT_GT(blue_in(false), left + 20);
}

/// The matrix that an outline is sent with has the cut in the place of a plane of the view: the model server then selects what is seen.
TEST_F(CutPictures, an_outline_takes_what_the_cut_leaves) {
  const TestSource source = two_plates();
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (const Vec3& at : source.positions) nodes.push_back({static_cast<std::int64_t>(nodes.size() + 1), at});
  for (const mesh::ShellNodes& shell : source.shell_nodes) {
    test::ShellSpec& added = shells.emplace_back();
    added.id = static_cast<std::int64_t>(shells.size());
    for (const mesh::NodeIndex node : shell.node) added.nodes.push_back(std::int64_t{node.value} + 1);
  }
  const mesh::Model model = test::make_model(nodes, shells);
  mesh::NodeSet all;
  for (std::size_t n = 0; n < model.node_count(); ++n) all.emplace_back(n);
  struct Trial {
    Vec3 point, normal;
  };
  // Planes whose cut away side is toward the eye, away from it, and aside.
  for (const Trial& trial : {Trial{{0, 0, 0}, {0, 0, 1}}, Trial{{0, 0, 0}, {0, 0, -1}}, Trial{{5, 0, 0}, {1, 0, 0}},
                             Trial{{5, 0, 0}, {-1, 0, 0}}, Trial{{3, 2, 1}, Vec3(1, -0.7, 0.4).normalized()}}) {
    cut(trial.point, trial.normal);
    const Eigen::Matrix4d clip = stereo::clip_with_cut(aim(), trial.point, trial.normal);
    std::array<double, 16> view{};
    std::copy_n(clip.data(), 16, view.begin());
    const Result<mesh::NodeSet> seen = mesh::select::visible_nodes(model, view, all, {});
    ASSERT_TRUE(seen) << seen.error().text();
    // What the picture shows, by its own pixels; nodes at the plane itself may be either.
    std::size_t differ = 0;
    const mesh::NodeSet shown = renderer_->nodes_in(aim(), {0, 0, kCutWidth, kCutHeight}, false);
    for (const mesh::NodeIndex node : all) {
      const bool a = std::binary_search(seen->begin(), seen->end(), node), b = std::binary_search(shown.begin(), shown.end(), node);
      if (a != b) ++differ;
      const double above = (model.position(node) - trial.point).dot(trial.normal);
      if (above > 0.01) {
        EXPECT_FALSE(a) << node.value << " is cut away";
      }
    }
    EXPECT_GT(seen->size(), 50U);
    EXPECT_LE(differ, all.size() / 25) << "at silhouettes pixels are coarser";
  }
}

TEST_F(CutPictures, a_copy_follows_what_changed) {
  TestSource source = two_plates();
  ModelCopy copy;
  copy.update(source);
  EXPECT_EQ(copy.model().node_count(), 242U);
  EXPECT_EQ(copy.model().shell_count(), 200U);
  source.positions[7] = Vec3(1, 2, 3);
  copy.update(source);
  EXPECT_NE(copy.model().positions[7], Vec3(1, 2, 3)) << "the chunk's version is the same";
  source.touch(ipc::SnapshotArray::positions, 0);
  source.hidden[1] = true;
  source.shell_nodes[3].node[2] = mesh::NodeIndex(std::size_t{100000});
  source.touch(ipc::SnapshotArray::shell_nodes, 0);
  copy.update(source);
  EXPECT_EQ(copy.model().positions[7], Vec3(1, 2, 3));
  EXPECT_EQ(copy.hidden(), (std::vector<std::uint8_t>{0, 1}));
  EXPECT_TRUE(copy.model().is_removed(mesh::ShellIndex(std::size_t{3}))) << "a node out of range";
  EXPECT_FALSE(copy.model().is_removed(mesh::ShellIndex(std::size_t{4})));
  TestSource other;
  other.key = 2;
  copy.update(other);
  EXPECT_EQ(copy.model().shell_count(), 0U);
}

}  // namespace
}  // namespace prismesh::kiosk::render
