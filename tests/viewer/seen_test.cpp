// What is seen of panels with known content: columns, ramps, single stripes.
#include "tests/viewer/seen.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/viewer/other_displays.h"
#include "tests/viewer/owners.h"

namespace prismesh::viewer {
namespace {

MaskDisplay small_display() {
  MaskDisplay display;
  display.panel.columns = 200;
  display.panel.rows = 8;
  return display;
}

/// Even columns in one colour, odd ones in another.
LightImage columns(const Panel& panel, Colour even, Colour odd) {
  LightImage picture(panel.columns, panel.rows);
  for (int y = 0; y < panel.rows; ++y)
    for (int x = 0; x < panel.columns; ++x) picture.at(x, y) = x % 2 == 0 ? even : odd;
  return picture;
}

constexpr Colour kRed{1, 0, 0}, kBlue{0, 0, 1}, kWhite{1, 1, 1}, kBlack{0, 0, 0};

TEST(Seen, each_eye_sees_its_columns_only) {
  const MaskDisplay display = small_display();
  const Eyes eyes = eyes_around({0, 0, 650});
  const LightImage picture = columns(display.panel, kWhite, kBlack);
  const Seen left = *look(display, picture, eyes.left, 0), right = *look(display, picture, eyes.right, 0);
  ASSERT_GT(left.elements, 97);
  for (int y = 0; y < left.rows; ++y)
    for (int x = 0; x < left.elements; ++x)
      for (const float light : left.at(x, y)) EXPECT_NEAR(light, 1, 0.03);
  for (int x = 0; x < right.elements; ++x)
    for (const float light : right.at(x, 3)) EXPECT_NEAR(light, 0, 0.03);
}

TEST(Seen, half_a_period_of_the_mask_swaps_the_eyes) {
  const MaskDisplay display = small_display();
  const Eyes eyes = eyes_around({0, 0, 650});
  const LightImage picture = columns(display.panel, kRed, kBlue);
  const Seen seen = *look(display, picture, eyes.left, 0.5 * display.element_pitch_mm());
  EXPECT_NEAR(seen.at(50, 4)[0], 0, 0.03);
  EXPECT_NEAR(seen.at(50, 4)[2], 1, 0.03);
}

TEST(Seen, a_quarter_period_of_the_mask_mixes_half_of_each) {
  const MaskDisplay display = small_display();
  const Seen seen =
      *look(display, columns(display.panel, kWhite, kBlack), eyes_around({0, 0, 650}).left, 0.25 * display.element_pitch_mm());
  // A window across two columns has the stripes of one side from the one, of the other side from the other.
  const Colour light = seen.at(50, 4);
  EXPECT_NEAR(light[0] + light[1] + light[2], 1.5, 0.03);
  EXPECT_NEAR(light[1], 0.5, 0.03) << "the middle stripe is cut";
  EXPECT_NEAR(std::abs(light[0] - light[2]), 1, 0.03) << "a colour fringe";
}

TEST(Seen, whole_pixels_mix_all_colours_alike) {
  MaskDisplay display = small_display();
  display.panel.stripes = Stripes::none;
  const Seen seen = *look(display, columns(display.panel, kWhite, kBlack), eyes_around({0, 0, 650}).left, 0.1 * display.element_pitch_mm());
  for (const float light : seen.at(50, 4)) EXPECT_NEAR(light, 0.8, 0.03);
}

TEST(Seen, stripes_are_at_the_panels_positions) {
  MaskDisplay display = small_display();
  LightImage picture(display.panel.columns, display.panel.rows);
  for (int y = 0; y < display.panel.rows; ++y) picture.at(100, y) = kWhite;
  const Sharpness third{1.0 / 3, 0};
  for (const Stripes stripes : {Stripes::rgb, Stripes::bgr}) {
    display.panel.stripes = stripes;
    for (int stripe = 0; stripe < 3; ++stripe) {
      // An eye straight above: the mask is placed so that element 0's window is in the middle of this stripe.
      const double wanted = (stripe + 0.5) / 3 * display.panel.pitch_mm;
      const Point eye{0, 0, 650};
      const double mask = wanted * eye.z / (eye.z + display.air_gap_mm());
      const Seen seen = *look(display, picture, eye, mask, third);
      const int channel = stripes == Stripes::rgb ? stripe : 2 - stripe;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen.at(-seen.first_element, 4)[c], c == channel ? 3 : 0, 1e-3) << stripe;
    }
  }
}

TEST(Seen, leak_is_the_other_eyes_light) {
  const MaskDisplay display = small_display();
  const Seen seen = *look(display, columns(display.panel, kRed, kBlue), eyes_around({0, 0, 650}).left, 0, {1, 0.07});
  EXPECT_NEAR(seen.at(50, 4)[0], 1, 0.03);
  EXPECT_NEAR(seen.at(50, 4)[2], 0.07, 0.01);
}

TEST(Seen, black_between_stripes_does_not_darken_a_whole_pixel) {
  MaskDisplay display = small_display();
  display.panel.black_share = 0.3;
  const Seen seen = *look(display, LightImage(200, 8, kWhite), eyes_around({0, 0, 650}).left, 0);
  for (const float light : seen.at(50, 4)) EXPECT_NEAR(light, 1, 1e-4) << "a pixel's light doesn't depend on its distribution";
}

TEST(Seen, the_grid_shows_a_ramp_where_it_is) {
  const MaskDisplay display = small_display();
  LightImage ramp(200, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 200; ++x) ramp.at(x, y).fill(static_cast<float>((x + 0.5) / 200));
  for (const Point between : {Point{0, 0, 650}, Point{80, 40, 520}}) {
    const Seen seen = *look(display, ramp, between, display.ideal_mask_mm(between));
    const LightImage grid = on_grid(display, seen, 100);
    for (int x = 3; x < 97; ++x) EXPECT_NEAR(grid.at(x, 4)[1], (x + 0.5) / 100, 0.004) << x;
    EXPECT_LT(mean_difference(seen, ordinary(display, ramp, seen)), 0.5);
  }
}

TEST(Seen, finds_the_share_of_the_other_picture) {
  const MaskDisplay display = small_display();
  LightImage own(200, 8), other(200, 8), mixed(200, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 200; ++x) {
      const float a = 0.5F + 0.4F * std::sin(0.31F * static_cast<float>(x)), b = 0.5F + 0.4F * std::sin(0.23F * static_cast<float>(x + y));
      own.at(x, y) = {a, a, a}, other.at(x, y) = {b, b, b};
      for (std::size_t c = 0; c < 3; ++c) mixed.at(x, y)[c] = 0.1F + 0.8F * a + 0.15F * b;
    }
  const Seen places = *look(display, own, {0, 0, 650}, 0);
  EXPECT_NEAR(share_of_other(ordinary(display, mixed, places), ordinary(display, own, places), ordinary(display, other, places)), 0.15,
              0.005);
  EXPECT_EQ(share_of_other(places, places, places), 0);
}

TEST(Seen, counts_pieces) {
  const MaskDisplay display = small_display();
  const LightImage dark(200, 8);
  LightImage lines = dark;
  for (int x = 40; x < 60; ++x) lines.at(x, 2) = kWhite;
  for (int x = 90; x < 120; ++x) lines.at(x, x / 2 % 2 + 4) = kWhite;
  const Point eye = eyes_around({0, 0, 650}).left;
  EXPECT_EQ(pieces_in(*look(display, lines, eye, 0), *look(display, dark, eye, 0)), 2);
  EXPECT_EQ(pieces_in(*look(display, dark, eye, 0), *look(display, dark, eye, 0)), 0);
}

TEST(Seen, refuses_impossible_values) {
  const MaskDisplay display = small_display();
  EXPECT_FALSE(look(display, LightImage(199, 8), {0, 0, 650}, 0));
  EXPECT_FALSE(look(display, LightImage(200, 8), {0, 0, -650}, 0));
  EXPECT_FALSE(look(display, LightImage(200, 8), {0, 0, 650}, 0, {0, 0}));
}

Owners alternating(const Panel& panel, int stripes_shifted = 0) {
  LightImage left(panel.columns, panel.rows), right = left;
  for (int y = 0; y < panel.rows; ++y)
    for (int stripe = 0; stripe < 3 * panel.columns; ++stripe) {
      const bool is_left = (stripe - stripes_shifted + 6 * panel.columns) / 3 % 2 == 0;
      (is_left ? left : right).at(stripe / 3, y)[static_cast<std::size_t>(stripe % 3)] = 1;
    }
  return *owners_of(panel, left, right);
}

TEST(Owners, stripes_are_read_from_pictures) {
  const Panel panel = small_display().panel;
  const Owners owners = alternating(panel, 1);
  EXPECT_EQ(owners.at(3, 0), Owner::right);
  EXPECT_EQ(owners.at(3, 1), Owner::left);
  EXPECT_EQ(owners.at(3, 3), Owner::left);
  EXPECT_EQ(owners.at(3, 4), Owner::right);
  EXPECT_FALSE(owners_of(panel, LightImage(4, 4), LightImage(4, 5)));
}

TEST(PhaseErrors, are_the_distance_from_the_window_to_the_middle_of_the_run) {
  const MaskDisplay display = small_display();
  const Eyes eyes = eyes_around({0, 0, 650});
  EXPECT_LT(phase_summary(display, alternating(display.panel), eyes, 0, {4}).worst_pixels, 0.02);
  const PhaseSummary third = phase_summary(display, alternating(display.panel, 1), eyes, 0, {4});
  EXPECT_NEAR(third.mean_pixels, 1.0 / 3, 0.02);
  EXPECT_NEAR(third.mean_wrong_share, 1.0 / 3, 0.02);
  // The mask's own error, given as its true position relative to the servo's, acts like a wrong picture.
  MaskDisplay off = display;
  off.offset_mm = 0.05;
  EXPECT_NEAR(phase_summary(off, alternating(display.panel), eyes, 0, {4}).mean_pixels, 0.05 / 0.2805, 0.02);
  for (const PhaseError& error : phase_errors(off, alternating(display.panel), Owner::left, eyes.left, 0, {4}))
    EXPECT_LT(error.off_pixels, 0) << "the window is to the right of what is the eye's";
  EXPECT_TRUE(
      std::isinf(phase_summary(display, *owners_of(display.panel, LightImage(200, 8), LightImage(200, 8)), eyes, 0, {4}).worst_pixels));
}

TEST(PhaseErrors, grow_at_the_screens_edge_with_depth_as_the_law_says) {
  MaskDisplay display;
  display.panel.rows = 1;
  for (const double distance : {580.0, 700.0}) {
    const PhaseSummary summary = phase_summary(display, alternating(display.panel), eyes_around({0, 0, distance}), 0, {0});
    const double law = 0.5 * display.panel.width_mm() * display.air_gap_mm() * std::abs(1 / distance - 1.0 / 650) / display.panel.pitch_mm;
    EXPECT_NEAR(summary.worst_pixels, law, 0.12) << distance;
  }
}

TEST(PlainDisplays, give_each_eye_its_part) {
  LightImage picture(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) picture.at(x, y) = {static_cast<float>(x), static_cast<float>(y), 0.5F};
  EXPECT_EQ(seen_on(PlainKind::rows, picture, true).at(3, 1)[1], 2);
  EXPECT_EQ(seen_on(PlainKind::rows, picture, false).at(3, 1)[1], 3);
  EXPECT_EQ(seen_on(PlainKind::rows, picture, false, true).at(3, 1)[1], 2);
  EXPECT_EQ(seen_on(PlainKind::side_by_side, picture, false).at(1, 3)[0], 3);
  EXPECT_EQ(seen_on(PlainKind::top_bottom, picture, false).at(1, 1)[1], 3);
  EXPECT_EQ(seen_on(PlainKind::anaglyph, picture, true).at(2, 1)[2], 2);
  EXPECT_EQ(seen_on(PlainKind::rows, picture, true, false, 0.1).at(0, 1)[1], 2 + 0.1F * 3);
  EXPECT_FALSE(plain_kind_from("hologram"));
}

TEST(PlainDisplays, resizing_keeps_the_light) {
  LightImage picture(6, 2);
  for (int x = 0; x < 6; ++x) picture.at(x, 0) = {static_cast<float>(x), 0, 0};
  const LightImage small = resized(picture, 4, 1);
  EXPECT_NEAR(small.at(0, 0)[0], 0.5 * (0 * 1 + 1 * 0.5) / 1.5, 1e-6);
  double sum = 0;
  for (const Colour& pixel : small.pixels) sum += pixel[0];
  EXPECT_NEAR(sum, 15 / 3.0, 1e-5);
  EXPECT_EQ(resized(picture, 12, 4).at(11, 1)[0], 5);
}

}  // namespace
}  // namespace prismesh::viewer
