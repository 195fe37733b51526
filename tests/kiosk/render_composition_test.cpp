// Composition of a picture, without drawing.
#include "kiosk/render/composition.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace prismesh::kiosk::render {
namespace {

using stereo::Eye;

Picture picture_of(const std::string& profile) {
  Picture picture;
  picture.profile = *stereo::find_profile(profile);
  return picture;
}

/// Column of the picture at the middle of an image's texel, in a row.
double column_of(const ComposedImage& image, double texel, double row) {
  const double x = 2 * (texel + 0.5) / image.width - 1;
  return (x - image.from_picture(0, 2) - image.from_picture(0, 1) * row) / image.from_picture(0, 0);
}

TEST(Composition, at_the_design_position_texels_are_on_their_eyes_columns) {
  for (const int width : {1280, 641, 1366, 63}) {
    Picture picture = picture_of("prism-mask");
    picture.profile.optics.refractive_index = 1;
    const Composition composed = compose(picture, width, 100);
    ASSERT_EQ(composed.images.size(), 2U);
    for (int column = 0; column < width; ++column) {
      const std::size_t owner = column % 2;
      const auto numbers = numbers_at(composed.phases, 100, column + 0.5, 50.5);
      EXPECT_NEAR(numbers[owner], std::round(numbers[owner]), 1e-4) << width << " " << column;
      EXPECT_NEAR(column_of(composed.images[owner], std::round(numbers[owner]), 50.5), column + 0.5, 1e-4) << width << " " << column;
    }
  }
}

TEST(Composition, texels_are_where_their_windows_are_seen) {
  for (const char* name : {"prism-mask", "lenticular"})
    for (const Vec3& head : {Vec3(0, 0, 560), Vec3(150, -60, 500), Vec3(-220, 40, 900)}) {
      Picture picture = picture_of(name);
      picture.between_eyes_mm = head;
      picture.mask_mm = 0.37;
      picture.panel = {211, 97, 1920, 1080};
      const Composition composed = compose(picture, 1280, 720);
      double worst = 0;
      for (const std::size_t eye : {0U, 1U}) {
        EXPECT_LE(composed.phases.windows[eye], composed.images[eye].width);
        for (double x = 1; x < 1280; x += 13.7)
          for (double y = 2; y < 720; y += 55.5)
            worst = std::max(worst, std::abs(column_of(composed.images[eye], numbers_at(composed.phases, 720, x, y)[eye], y) - x));
      }
      EXPECT_LT(worst, 0.5) << name << ": pixels, as windows are assumed to be evenly spaced; head at " << head.transpose();
    }
}

TEST(Composition, images_keep_their_size_while_a_head_moves) {
  Picture picture = picture_of("prism-mask");
  const int width = compose(picture, 1920, 1080).images[0].width;
  EXPECT_LT(width, 0.53 * 1920);
  for (double x = -250; x <= 250; x += 37)
    for (double z = 450; z <= 1100; z += 50) {
      picture.between_eyes_mm = {x, 0.3 * x, z};
      EXPECT_EQ(compose(picture, 1920, 1080).images[1].width, width) << x << " " << z;
    }
}

TEST(Composition, pictures_are_drawn_from_the_pointers_viewpoint) {
  for (const char* name : {"prism-mask", "side-by-side", "anaglyph", "mono", "mono-right"})
    for (const double share : {0.0, 0.4, 1.0}) {
      Picture picture = picture_of(name);
      picture.between_eyes_mm = {70, 30, 620};
      picture.toward_right = {0.9, 0.2, 0.1};
      picture.eye_separation_mm = 60;
      picture.depth_share = share;
      picture.panel = {400, 100, 1920, 1080};
      const Composition composed = compose(picture, 800, 600);
      const stereo::Aim aim = aim_for(picture, 800, 600);
      bool found = false;
      for (const ComposedImage& image : composed.images) found = found || (image.eye_mm - aim.eye_mm).norm() < 1e-9;
      EXPECT_TRUE(found) << name << " " << share;
      // 400 + 400 columns from the left is 160 columns left of the panel's middle; 100 + 300 rows from the top 140 rows above it.
      const double pitch = picture.profile.optics.pixel_pitch_mm;
      if (share == 0) {
        EXPECT_LT((aim.eye_mm - Vec3(70 + 160 * pitch, 30 - 140 * pitch, 620)).norm(), 1e-9) << name;
      }
    }
}

TEST(Composition, without_depth_there_is_one_picture_for_both_eyes) {
  for (const auto& profile : stereo::built_in_profiles()) {
    Picture picture = picture_of(profile.name);
    picture.depth_share = 0;
    const Composition composed = compose(picture, 640, 360);
    EXPECT_EQ(composed.images.size(), 1U) << profile.name;
    if (profile.interlaced()) {
      EXPECT_EQ(composed.join, Join::alone) << profile.name;
      EXPECT_EQ(composed.images[0].width, 640);
    }
  }
}

TEST(Composition, fixed_columns_follow_a_mask_that_moved_back_by_half_periods) {
  Picture picture = picture_of("prism-mask-columns");
  const auto left_first = [&] {
    const auto numbers = numbers_at(compose(picture, 64, 64).phases, 64, 0.5, 0.5);
    return std::abs(numbers[0] - std::round(numbers[0])) < std::abs(numbers[1] - std::round(numbers[1]));
  };
  const double half = 0.5 * picture.profile.optics.mask_pitch_mm();
  for (const int halves : {-3, -2, -1, 0, 1, 2, 5}) {
    picture.between_eyes_mm = {100, 0, 700};
    picture.mask_mm = mask_position_mm(picture.profile.optics, picture.between_eyes_mm) - halves * half + 0.02;
    EXPECT_EQ(left_first(), halves % 2 == 0) << halves;
  }
}

TEST(Composition, values_that_are_not_finite_give_a_valid_composition) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
  for (const double bad : {nan, huge, -huge, 0.0})
    for (const auto& profile : stereo::built_in_profiles()) {
      Picture picture = picture_of(profile.name);
      picture.between_eyes_mm = {bad, 0, bad};
      picture.toward_right = {bad, 0, 0};
      picture.eye_separation_mm = picture.depth_share = bad;
      picture.mask_mm = bad == huge ? nan : bad == nan ? huge : bad;
      const Composition composed = compose(picture, 320, 200);
      for (const ComposedImage& image : composed.images) {
        EXPECT_TRUE(image.from_picture.allFinite()) << profile.name;
        EXPECT_GT(image.width, 0);
        EXPECT_LT(image.width, 1000);
      }
    }
}

}  // namespace
}  // namespace prismesh::kiosk::render
