#include "kiosk/calibration/pattern_painter.h"

#include <array>

#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::calibration {
namespace {

using Rgb = std::array<int, 3>;

class CalibrationPattern : public render::RenderTest {
 protected:
  render::Image painted(const Pattern& pattern, const char* profile, int width = 640, int height = 400) {
    Result<PatternPainter> painter = PatternPainter::create();
    EXPECT_TRUE(painter) << painter.error().text();
    render::Picture picture;
    picture.profile = *stereo::find_profile(profile);
    picture.overlay = [&](const render::EyeImage& image) { painter->paint(pattern, image); };
    return draw(picture, width, height);
  }
};

Rgb at(const render::Image& image, int x, int y_from_above) {
  const std::uint8_t* pixel = image.at(x, y_from_above);
  return {pixel[0], pixel[1], pixel[2]};
}

constexpr Rgb kRed{255, 0, 0}, kBlue{0, 0, 255}, kWhite{255, 255, 255}, kBlack{0, 0, 0};

TEST_F(CalibrationPattern, stripes_are_drawn_on_display_pixels) {
  const render::Image image = painted(colour_stripes(), "mono");
  for (int x = 160; x < 320; ++x) EXPECT_EQ(at(image, x, 100), x % 2 == 0 ? kRed : kBlue) << x;
  for (int x = 320; x < 480; ++x) EXPECT_EQ(at(image, x, 100), x / 2 % 2 == 0 ? kRed : kBlue) << x;
  EXPECT_EQ(at(image, 100, 100), at(image, 500, 300));  // the ground
}

TEST_F(CalibrationPattern, each_eye_has_its_own_fields) {
  for (const bool left : {true, false}) {
    const render::Image image = painted(one_eye_bright(left), "prism-mask");
    for (const int y : {0, 200, 399})
      for (int x = 0; x < 640; ++x) ASSERT_EQ(at(image, x, y), (x % 2 == 0) == left ? kWhite : kBlack) << x << " " << y;
  }
}

TEST_F(CalibrationPattern, the_bar_has_its_length_in_pixels) {
  const Pattern pattern = ruler_bar(640);
  ASSERT_EQ(pattern.bars.front().pixels, 500);
  const render::Image image = painted(pattern, "mono");
  int bright = 0;
  for (int x = 0; x < 640; ++x) bright += at(image, x, 104) == kWhite ? 1 : 0;
  EXPECT_EQ(bright, 500);
}

TEST_F(CalibrationPattern, one_eye_sees_one_grey_and_the_other_black_and_white) {
  const render::Image image = painted(crosstalk_patches(true), "prism-mask");
  const Rgb grey = at(image, 120, 100);
  EXPECT_EQ(at(image, 500, 100), grey);
  EXPECT_EQ(at(image, 121, 100), kBlack);
  EXPECT_EQ(at(image, 501, 100), kWhite);
}

TEST_F(CalibrationPattern, each_eye_sees_its_own_mark) {
  const render::Image left = painted(eye_marks(), "mono-left"), right = painted(eye_marks(), "mono-right");
  const int bar_x = 176, bar_y = 120, lying_x = 450, lying_y = 116;
  EXPECT_EQ(at(left, bar_x, bar_y), kWhite);
  EXPECT_NE(at(right, bar_x, bar_y), kWhite);
  EXPECT_EQ(at(right, lying_x, lying_y), kWhite);
  EXPECT_NE(at(left, lying_x, lying_y), kWhite);
  EXPECT_EQ(at(left, 320, 36), kWhite);
  EXPECT_EQ(at(right, 320, 36), kWhite);
}

}  // namespace
}  // namespace prismesh::kiosk::calibration
