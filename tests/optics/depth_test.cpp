// Depth: a known point is drawn, woven and seen by both eyes; it appears where their directions meet.
#include <array>
#include <cmath>
#include <iostream>

#include "tests/optics/optics_fixture.h"

namespace prismesh::optics {
namespace {

constexpr double kToleranceMm = 3;            ///< at 100 mm
constexpr double kToleranceOnScreenMm = 1.5;  ///< a false parallax of one pixel would be 2.9 mm at 650 mm

class Depth : public OpticsTest {
 protected:
  void SetUp() override {
    OpticsTest::SetUp();
    if (!IsSkipped()) make_renderer({});
  }

  /// A square of 5 mm that faces the viewer, slightly rotated: sides parallel to the rows would hide their position between two rows.
  void show_square(const Vec3& middle) {
    test::TestSource source;
    for (const auto& [x, y] : {std::array{-3.2, -1.5}, {1.5, -3.2}, {3.2, 1.5}, {-1.5, 3.2}}) source.add_node(middle + Vec3(x, y, 0));
    source.add_shell(0, 1, 2, 3, 0);
    source.key = ++key_;
    show(source);
  }

  Picture picture_for(const Vec3& head, const Vec3& toward_right = Vec3::UnitX()) const {
    Picture picture = at_head("prism-mask", head);
    picture.toward_right = toward_right;
    picture.element_edges = picture.outlines = false;
    picture.view.bounds.radius = 75;  // includes planes at 100 mm in the drawn range, so that depth isn't compressed
    return picture;
  }

  /// Where the square appears, in mm from the middle of the screen's apparent surface: behind the glass the panel appears nearer than it
  /// is, an air gap behind the mask.
  Vec3 seen_at(const viewer::MaskDisplay& display, const Picture& picture, const viewer::Sharpness& sharpness = {}) {
    const viewer::LightImage drawn = woven(picture, display.panel);
    renderer_->set_model(nullptr);
    const viewer::LightImage ground = woven(picture, display.panel);
    const viewer::Eyes eyes = eyes_of(picture);
    const double mask = display.ideal_mask_mm(point(picture.between_eyes_mm));
    std::array<viewer::Window, 2> directions;
    for (const std::size_t i : {0, 1}) {
      const viewer::Point& eye = i == 0 ? eyes.left : eyes.right;
      const auto view = viewer::Viewpoint::at(display, eye, mask, sharpness);
      EXPECT_TRUE(view);
      const viewer::Spot spot = viewer::spot_in(*view->look(drawn), *view->look(ground));
      EXPECT_GT(spot.light, 5) << "the square isn't seen";
      const double v = (0.5 * display.panel.rows - spot.row) * display.panel.pitch_mm;
      directions[i] = viewer::window_of(display, eye, mask, spot.element, v);
    }
    const viewer::Point at = viewer::triangulated(eyes, directions[0], directions[1]);
    return {at.x, at.y, at.z + display.air_gap_mm()};
  }

  std::uint64_t key_ = 0;
};

const std::array kHeads{Vec3(0, 0, 650), Vec3(0, 0, 500), Vec3(0, 0, 800), Vec3(120, 50, 650), Vec3(-140, -60, 560)};

TEST_F(Depth, a_known_point_appears_at_its_position) {
  const viewer::MaskDisplay display = OpticsTest::display(1280, 200);
  double worst = 0, worst_aside = 0;
  for (const Vec3& head : kHeads)
    for (const double depth : {-100.0, 0.0, 100.0})
      for (const double aside : {-70.0, 0.0, 70.0}) {
        const Vec3 at(aside, 0.1 * aside, depth);
        show_square(at);
        const Vec3 seen = seen_at(display, picture_for(head));
        EXPECT_NEAR(seen.z(), depth, depth == 0 ? kToleranceOnScreenMm : kToleranceMm)
            << "head " << head.transpose() << ", point " << at.transpose();
        worst = std::max(worst, std::abs(seen.z() - depth));
        worst_aside = std::max(worst_aside, (seen - at).head<2>().norm());
      }
  std::cout << "depth of a known point: " << worst << " mm off at worst, " << worst_aside << " mm sideways\n";
  EXPECT_LT(worst_aside, 2);
}

TEST_F(Depth, a_tilted_head_sees_the_same_depth) {
  const viewer::MaskDisplay display = OpticsTest::display(1280, 200);
  for (const double depth : {-100.0, 100.0}) {
    show_square({20, 10, depth});
    const Vec3 seen = seen_at(display, picture_for({30, 20, 620}, Vec3(0.97, 0.2, 0.14).normalized()));
    EXPECT_NEAR(seen.z(), depth, kToleranceMm);
  }
}

TEST_F(Depth, without_depth_the_square_appears_on_the_screen) {
  const viewer::MaskDisplay display = OpticsTest::display(1280, 200);
  show_square({0, 0, 80});
  Picture picture = picture_for({0, 0, 650});
  picture.depth_share = 0;
  EXPECT_NEAR(seen_at(display, picture).z(), 0, 1.5);
}

}  // namespace
}  // namespace prismesh::optics
