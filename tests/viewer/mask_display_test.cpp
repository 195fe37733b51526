// The traced display compared with values computed by hand.
#include "tests/viewer/mask_display.h"

#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::viewer {
namespace {

TEST(MaskDisplay, has_the_examples_dimensions) {
  const MaskDisplay display;
  EXPECT_NEAR(display.air_gap_mm(), 2.894, 5e-4);
  EXPECT_NEAR(display.glass_mm(), 4.40, 5e-3);
  EXPECT_NEAR(display.element_pitch_mm(), 0.5585, 5e-5);
  EXPECT_NEAR(display.ideal_mask_mm({1, 0, 650}) * 1000, 4.43, 5e-3) << "micrometres per millimetre of the head";
  EXPECT_NEAR(display.ideal_mask_mm({63, 0, 650}), 0.5 * display.element_pitch_mm(), 1e-9) << "one eye separation: the eyes swap";
}

TEST(MaskDisplay, a_ray_in_air_goes_straight) {
  MaskDisplay air;
  air.index = 1;
  const Point eye{-120, 60, 500};
  const PanelPlace place = seen_through(air, eye, 80, -30);
  const double t = (eye.z + air.glass_mm()) / eye.z;
  EXPECT_NEAR(place.u_mm, eye.x + t * (80 - eye.x), 1e-9);
  EXPECT_NEAR(place.v_mm, eye.y + t * (-30 - eye.y), 1e-9);
}

TEST(MaskDisplay, a_refracted_ray_obeys_snell) {
  const MaskDisplay display;
  const Point eye{40, -20, 600};
  const double x = 150, y = 110;
  const PanelPlace place = seen_through(display, eye, x, y);
  const double before = std::hypot(x - eye.x, y - eye.y), inside = std::hypot(place.u_mm - x, place.v_mm - y);
  const double sine_before = before / std::hypot(before, eye.z), sine_inside = inside / std::hypot(inside, display.glass_mm());
  EXPECT_NEAR(sine_before, display.index * sine_inside, 1e-12);
  EXPECT_NEAR((place.u_mm - x) * (y - eye.y), (place.v_mm - y) * (x - eye.x), 1e-9) << "and stays in its plane";
}

TEST(MaskDisplay, at_the_design_distance_columns_alternate_between_the_eyes) {
  for (const int columns : {1280, 1366, 1279, 1281}) {
    MaskDisplay display;
    display.panel.columns = columns;
    const Eyes eyes = eyes_around({0, 0, 650});
    for (int element = -40; element <= 40; ++element) {
      const auto column = [&](const Point& eye) {
        return window_of(display, eye, 0, element, 0).u_mm / display.panel.pitch_mm + 0.5 * columns - 0.5;
      };
      const double left = column(eyes.left), right = column(eyes.right);
      EXPECT_NEAR(left, std::round(left), 0.02) << columns;
      EXPECT_EQ(std::lround(left) % 2, 0) << columns << ": the left eye has the even columns";
      EXPECT_NEAR(right, left - 1, 0.02) << columns << ": the right eye sees the column to the left of it";
    }
  }
}

TEST(MaskDisplay, the_mask_follows_the_head) {
  MaskDisplay display;
  display.lean = 0.1;
  for (const Point head : {Point{0, 0, 650}, Point{55, 30, 580}, Point{-90, -80, 720}}) {
    const double mask = display.ideal_mask_mm(head);
    MaskDisplay air = display;  // the law is the one without refraction
    air.index = 1;
    const double place = window_of(air, head, mask, 0, 0).u_mm;
    EXPECT_NEAR(place, 0, 1e-9) << "element 0 stays over the panel's middle";
  }
}

TEST(MaskDisplay, window_and_element_are_inverse_functions) {
  MaskDisplay display;
  display.lean = -0.21;
  const Point eye{-75, 42, 560};
  for (const double element : {-300.0, -20.5, 0.0, 133.25}) {
    const Window window = window_of(display, eye, 0.13, element, 55);
    EXPECT_NEAR(element_at(display, eye, 0.13, window.u_mm, 55), element, 1e-6);
    const PanelPlace place = seen_through(display, eye, window.x_mm, window.y_mm);
    EXPECT_NEAR(place.v_mm, 55, 1e-6);
    EXPECT_NEAR(place.u_mm, window.u_mm, 1e-9);
    EXPECT_NEAR(window.x_mm, display.element_x_mm(element, 0.13, window.y_mm), 1e-9);
  }
}

TEST(MaskDisplay, two_directions_give_their_point) {
  const Eyes eyes = eyes_around({30, -15, 640}, 61, {1, 0.05, 0.1});
  const Point at{-40, 25, 90};
  const auto aim = [&](const Point& eye) {
    const double t = eye.z / (eye.z - at.z);
    return Window{0, eye.x + t * (at.x - eye.x), eye.y + t * (at.y - eye.y)};
  };
  const Point found = triangulated(eyes, aim(eyes.left), aim(eyes.right));
  EXPECT_NEAR(found.x, at.x, 1e-9);
  EXPECT_NEAR(found.y, at.y, 1e-9);
  EXPECT_NEAR(found.z, at.z, 1e-9);
}

TEST(MaskDisplay, invalid_values_are_named) {
  MaskDisplay display;
  EXPECT_TRUE(display.check());
  display.index = 0.5;
  ASSERT_FALSE(display.check());
  EXPECT_NE(display.check().error().message.find("refractive index"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::viewer
