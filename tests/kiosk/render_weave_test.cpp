// The woven picture: every column from its own eye, from the place where it stands, and thin lines whole for each eye.
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>

#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using stereo::Eye;

class Weave : public RenderTest {
 protected:
  /// A picture whose overlay floods each eye's image: the left one red, the right one blue.
  Picture flooded(const std::string& profile) {
    Picture picture;
    picture.profile = *stereo::find_profile(profile);
    picture.overlay = [this](const EyeImage& image) {
      images_.push_back(image);
      const bool left = image.eye == Eye::left;
      glClearColor(left ? 1.0F : 0.0F, image.eye ? 0.0F : 1.0F, image.eye == Eye::right ? 1.0F : 0.0F, 1.0F);
      glClear(GL_COLOR_BUFFER_BIT);
      glEnable(GL_BLEND);  // what an overlay leaves behind doesn't matter
      glBlendFunc(GL_ZERO, GL_ZERO);
      glEnable(GL_SCISSOR_TEST);
      glScissor(0, 0, 1, 1);
      glColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
    };
    return picture;
  }
  static bool is(const Image& image, int x, int y, std::array<int, 3> rgb) {
    const std::uint8_t* at = image.at(x, y);
    return at[0] == rgb[0] && at[1] == rgb[1] && at[2] == rgb[2];
  }
  std::vector<EyeImage> images_;
};

constexpr std::array<int, 3> kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};

TEST_F(Weave, EveryColumnComesFromItsOwnEye) {
  for (const int width : {64, 63})
    for (const bool swap : {false, true}) {
      Picture picture = flooded("prism-mask");
      picture.profile.swap_eyes = swap;
      images_.clear();
      const Image image = draw(picture, width, 9);
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < width; ++x) ASSERT_TRUE(is(image, x, y, (x % 2 == 0) != swap ? kRed : kBlue)) << x << " " << y << " " << swap;
      ASSERT_EQ(images_.size(), 2U);
      EXPECT_EQ(images_[0].width, 32);
      EXPECT_EQ(images_[0].display_width, 64);
      EXPECT_EQ(images_[0].height, 9);
    }
}

TEST_F(Weave, OtherDisplaysGetWhatTheyNeed) {
  const Image left = draw(flooded("mono-left"), 40, 10);
  EXPECT_TRUE(is(left, 3, 3, kRed));
  const Image right = draw(flooded("mono-right"), 40, 10);
  EXPECT_TRUE(is(right, 3, 3, kBlue));
  const Image centre = draw(flooded("mono"), 40, 10);
  EXPECT_TRUE(is(centre, 3, 3, kGreen));
  const Image side = draw(flooded("side-by-side"), 40, 10);
  EXPECT_TRUE(is(side, 19, 3, kRed));
  EXPECT_TRUE(is(side, 20, 3, kBlue));
  const Image anaglyph = draw(flooded("anaglyph"), 40, 10);
  EXPECT_NEAR(anaglyph.at(5, 5)[0], 76, 1) << "red shows how bright the left image is";
  EXPECT_EQ(anaglyph.at(5, 5)[2], 255) << "blue comes from the right";
}

/// A sheet in the screen's plane that covers everything left of a display column.
test::TestSource half_plane() {
  test::TestSource source;
  for (const mesh::Vec3& at : {mesh::Vec3(-1000, -1000, 0), mesh::Vec3(0, -1000, 0), mesh::Vec3(0, 1000, 0), mesh::Vec3(-1000, 1000, 0)})
    source.add_node(at);
  source.add_shell(0, 1, 2, 3, 0);
  return source;
}

TEST_F(Weave, EveryColumnShowsTheSceneWhereItStands) {
  show(half_plane());
  for (const int width : {256, 255})
    for (const bool swap : {false, true}) {
      int wrong = 0;
      for (double edge = 100.05; edge < 112; edge += 0.1) {
        Picture picture;
        picture.profile = *stereo::find_profile("prism-mask");
        picture.profile.swap_eyes = swap;
        picture.element_edges = picture.outlines = false;
        picture.view.pan_mm = {(edge - 0.5 * width) * picture.profile.pixel_pitch_mm, 0};
        const Image image = draw(picture, width, 4);
        for (int x = 0; x < width; ++x) wrong += (brightness(image, x, 2) > 140) != (x + 0.5 < edge);
      }
      EXPECT_EQ(wrong, 0) << "width " << width << ", swapped " << swap;
    }
}

/// Connected pieces (8 neighbours) of what differs from the ground in one eye's columns.
int pieces(const Image& image, const Image& ground, int eye) {
  const int width = image.width / 2;
  std::vector<char> ink(static_cast<std::size_t>(width) * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x)
      ink[static_cast<std::size_t>(y) * width + x] = std::abs(brightness(image, 2 * x + eye, y) - brightness(ground, 2 * x + eye, y)) > 8;
  int found = 0;
  for (std::size_t start = 0; start < ink.size(); ++start) {
    if (ink[start] == 0) continue;
    ++found;
    std::queue<std::size_t> open;
    open.push(start);
    ink[start] = 0;
    while (!open.empty()) {
      const int x = static_cast<int>(open.front()) % width, y = static_cast<int>(open.front()) / width;
      open.pop();
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, image.height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx)
          if (char& cell = ink[static_cast<std::size_t>(ny) * width + nx]; cell != 0) {
            cell = 0;
            open.push(static_cast<std::size_t>(ny) * width + nx);
          }
    }
  }
  return found;
}

TEST_F(Weave, AThinLineIsOnePieceForEachEye) {
  constexpr int kWidth = 256, kHeight = 160;
  Picture picture;
  picture.profile = *stereo::find_profile("prism-mask");
  const Image ground = draw(picture, kWidth, kHeight);
  for (int degrees = 0; degrees < 180; degrees += 3) {
    const double angle = (degrees + 0.37) * std::numbers::pi / 180;
    test::TestSource source;
    const mesh::Vec3 along(std::cos(angle) * 15, std::sin(angle) * 15, 0), middle(0.13, 0.07, 0);
    source.add_line(source.add_node(middle - along), source.add_node(middle + along), 0);
    source.key = static_cast<std::uint64_t>(degrees) + 10;
    show(source);
    const Image image = draw(picture, kWidth, kHeight);
    EXPECT_EQ(pieces(image, ground, 0), 1) << degrees;
    EXPECT_EQ(pieces(image, ground, 1), 1) << degrees;
  }
}

TEST_F(Weave, AnEyesColumnsLookLikeItsOwnPicture) {
  constexpr int kWidth = 640, kHeight = 360;
  show(test::make_crash_box());
  const Image woven = draw(fitted("prism-mask", "iso", kWidth, kHeight), kWidth, kHeight);
  for (const int eye : {0, 1}) {
    const Image own = draw(fitted(eye == 0 ? "mono-left" : "mono-right", "iso", kWidth, kHeight), kWidth, kHeight);
    const Image other = draw(fitted(eye == 0 ? "mono-right" : "mono-left", "iso", kWidth, kHeight), kWidth, kHeight);
    double to_own = 0, to_other = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = eye; x < kWidth; x += 2) {
        to_own += std::abs(brightness(woven, x, y) - brightness(own, x, y));
        to_other += std::abs(brightness(woven, x, y) - brightness(other, x, y));
      }
    const double columns = 0.5 * kWidth * kHeight;
    EXPECT_LT(to_own / columns, 4) << "mean difference in levels";
    EXPECT_GT(to_other, 1.5 * to_own) << "and not like the other eye's";
  }
}

TEST_F(Weave, TheRubberBandHasNoParallax) {
  Picture picture;
  picture.profile = *stereo::find_profile("prism-mask");
  const Image ground = draw(picture, 200, 120);
  picture.rubber_band = PixelRect{150, 90, 40, 20};
  const Image image = draw(picture, 200, 120);
  for (const int x : {90, 91}) {
    EXPECT_GT(brightness(image, x, 20), brightness(ground, x, 20) + 60) << "upper side, column " << x;
    EXPECT_GT(brightness(image, x, 90), brightness(ground, x, 90) + 40) << "lower side";
    EXPECT_GT(brightness(image, x, 50), brightness(ground, x, 50)) << "a little light inside";
    EXPECT_EQ(brightness(image, x, 10), brightness(ground, x, 10));
  }
  for (const int x : {40, 41, 150, 151}) EXPECT_GT(brightness(image, x, 50), brightness(ground, x, 50) + 30) << "column " << x;
  for (const int x : {20, 21, 170, 171}) EXPECT_EQ(brightness(image, x, 50), brightness(ground, x, 50));
}

}  // namespace
}  // namespace prismesh::kiosk::render
