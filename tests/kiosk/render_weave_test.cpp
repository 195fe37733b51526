// The woven picture: each column shows its own eye and the scene at its position, and thin lines are unbroken for each eye.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>

#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using stereo::Eye;

class Weave : public RenderTest {
 protected:
  /// A picture whose overlay fills each eye's image: the left one white, the right one black, the one from between grey.
  Picture flooded(const std::string& profile, float left = 1, float right = 0) {
    Picture picture;
    picture.profile = *stereo::find_profile(profile);
    picture.overlay = [this, left, right](const EyeImage& image) {
      images_.push_back(image);
      const float grey = image.eye == Eye::left ? left : image.eye == Eye::right ? right : 0.5F;
      glClearColor(grey, grey, grey, 1);
      glClear(GL_COLOR_BUFFER_BIT);
      glEnable(GL_BLEND);  // the state that an overlay leaves doesn't matter
      glBlendFunc(GL_ZERO, GL_ZERO);
      glEnable(GL_SCISSOR_TEST);
      glScissor(0, 0, 1, 1);
      glColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
    };
    return picture;
  }
  /// A picture whose images have numbered columns: 1 to 127, repeated, for the left eye, 128 more for the right one.
  Picture numbered(const std::string& profile) {
    Picture picture = flooded(profile);
    picture.overlay = [this](const EyeImage& image) {
      images_.push_back(image);
      glEnable(GL_SCISSOR_TEST);
      for (int column = 0; column < image.width; ++column) {
        const float grey = static_cast<float>(column % 127 + 1 + (image.eye == Eye::right ? 128 : 0)) / 255;
        glScissor(column, 0, 1, image.height);
        glClearColor(grey, grey, grey, 1);
        glClear(GL_COLOR_BUFFER_BIT);
      }
    };
    return picture;
  }
  std::vector<EyeImage> images_;
};

/// Positions of a pixel's three colours, in columns from its middle.
double colour_offset(const stereo::Profile& profile, int channel) {
  if (profile.subpixels == stereo::Subpixels::none) return 0;
  return (profile.subpixels == stereo::Subpixels::rgb ? channel - 1 : 1 - channel) / 3.0;
}

TEST_F(Weave, each_subpixel_shows_the_eye_and_the_window_that_sees_it) {
  struct Case {
    const char* profile;
    Vec3 head;
    std::optional<double> mask;
    stereo::Subpixels subpixels;
    bool swap;
    int width;
  };
  using stereo::Subpixels;
  const Case cases[] = {
      {"prism-mask", {0, 0, 650}, {}, Subpixels::rgb, false, 640},      {"prism-mask", {0, 0, 650}, {}, Subpixels::none, true, 641},
      {"prism-mask", {140, 60, 540}, 0.31, Subpixels::rgb, false, 639}, {"prism-mask", {-75, -60, 800}, -0.9, Subpixels::bgr, true, 642},
      {"lenticular", {50, 20, 700}, {}, Subpixels::rgb, false, 640},    {"lenticular", {-120, 90, 520}, 5.0, Subpixels::bgr, false, 333}};
  constexpr int kHeight = 96;
  for (const PanelPlace& place : {PanelPlace{}, PanelPlace{333, 210, 1920, 1080}})
    for (const Case& c : cases) {
      Picture picture = numbered(c.profile);
      picture.between_eyes_mm = c.head;
      picture.toward_right = Vec3(1, 0.2, 0);
      picture.mask_mm = c.mask;
      picture.panel = place;
      picture.profile.subpixels = c.subpixels;
      picture.profile.swap_eyes = c.swap;
      images_.clear();
      const Image image = draw(picture, c.width, kHeight);
      ASSERT_EQ(images_.size(), 2U);

      // Expected: by the definition of the optics.
      drivers::display::MaskOptics optics = picture.profile.optics;
      optics.panel_columns = place.width > 0 ? place.width : c.width;
      const double panel_rows = place.height > 0 ? place.height : kHeight;
      double mask = picture.profile.mask_moves ? c.mask.value_or(mask_position_mm(optics, c.head)) : 0;
      if (c.swap) mask += optics.mask_pitch_mm() / 2;
      const stereo::EyePair eyes = drivers::display::eyes_from(c.head, 63, picture.toward_right.normalized());
      int undecided = 0, seen[2] = {0, 0};
      for (int y = 0; y < kHeight; y += 5)
        for (int x = 0; x < c.width; ++x)
          for (int channel = 0; channel < 3; ++channel) {
            const double column = x + 0.5 + colour_offset(picture.profile, channel);
            const double u = (place.x + column - 0.5 * optics.panel_columns) * optics.pixel_pitch_mm;
            const double v = (0.5 * panel_rows - place.y - y - 0.5) * optics.pixel_pitch_mm;
            double off[2];
            for (const Eye eye : {Eye::left, Eye::right}) {
              const double number = window_number(optics, eyes.of(eye), mask, u, v);
              off[static_cast<int>(eye)] = std::abs(number - std::round(number));
            }
            if (std::abs(off[0] - off[1]) < 0.004) {
              ++undecided;
              continue;
            }
            const int shown = image.at(x, y)[channel], eye = off[0] < off[1] ? 0 : 1;
            ASSERT_EQ(shown >= 128, eye == 1) << c.profile << " " << x << "," << y << " channel " << channel << " offs " << off[0] << " "
                                              << off[1];
            // The texel shows the scene at this position, not at the next window.
            const EyeImage& from = images_[eye];
            const Eigen::Vector2d at = from.from_picture * Vec3(column, y + 0.5, 1);
            const double texel = 0.5 * (at.x() + 1) * from.width - 0.5;
            const double apart = std::remainder(texel - ((shown & 127) - 1), 127);
            ASSERT_LT(std::abs(apart), 0.5) << c.profile << " " << x << "," << y << " channel " << channel;
            ++seen[eye];
          }
      EXPECT_LT(undecided, 0.05 * c.width * kHeight * 3 / 5);
      EXPECT_GT(seen[0], 0.4 * c.width * kHeight * 3 / 5);
      EXPECT_GT(seen[1], 0.4 * c.width * kHeight * 3 / 5);
    }
}

TEST_F(Weave, every_column_or_row_comes_from_its_own_eye) {
  for (const char* name : {"prism-mask", "prism-mask-columns", "prism-mask-stencil", "row-interlaced"})
    for (const int width : {64, 63})
      for (const bool swap : {false, true}) {
        Picture picture = flooded(name);
        picture.profile.swap_eyes = swap;
        const bool rows = picture.profile.weave == stereo::Weave::rows;
        const Image image = draw(picture, width, 9);
        for (int y = 0; y < 9; ++y)
          for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel)
              ASSERT_EQ(image.at(x, y)[channel], ((rows ? y : x) % 2 == 0) != swap ? 255 : 0)
                  << name << " " << x << " " << y << " " << swap;
      }
}

TEST_F(Weave, parts_of_a_panel_continue_its_columns_and_rows) {
  for (const char* name : {"prism-mask", "prism-mask-columns", "prism-mask-stencil", "row-interlaced"}) {
    const Image whole = draw(flooded(name), 160, 90);
    for (const auto& [x0, y0] : {std::pair(0, 0), std::pair(7, 3), std::pair(30, 20)}) {
      Picture picture = flooded(name);
      picture.panel = {x0, y0, 160, 90};
      const Image part = draw(picture, 101, 41);
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 101; ++x) ASSERT_EQ(part.at(x, y)[1], whole.at(x + x0, y + y0)[1]) << name << " " << x << " " << y;
    }
  }
}

TEST_F(Weave, other_displays_get_their_layouts) {
  EXPECT_EQ(draw(flooded("mono-left"), 40, 10).at(3, 3)[0], 255);
  EXPECT_EQ(draw(flooded("mono-right"), 40, 10).at(3, 3)[0], 0);
  EXPECT_NEAR(draw(flooded("mono"), 40, 10).at(3, 3)[0], 128, 1);
  for (const bool swap : {false, true}) {
    const auto drawn = [&](const char* name, int width, int height) {
      Picture picture = flooded(name);
      picture.profile.swap_eyes = swap;
      return draw(picture, width, height);
    };
    const int first = swap ? 0 : 255, second = 255 - first;
    const Image side = drawn("side-by-side", 41, 10);
    EXPECT_EQ(side.at(20, 3)[1], first);
    EXPECT_EQ(side.at(21, 3)[1], second);
    const Image stacked = drawn("top-bottom", 20, 11);
    EXPECT_EQ(stacked.at(4, 5)[1], first) << "upper half";
    EXPECT_EQ(stacked.at(4, 6)[1], second);
    const Image anaglyph = drawn("anaglyph", 40, 10);
    EXPECT_NEAR(anaglyph.at(5, 5)[0], first, 1);
    EXPECT_EQ(anaglyph.at(5, 5)[1], second);
    EXPECT_EQ(anaglyph.at(5, 5)[2], second);
  }
}

/// A sheet in the screen's plane that covers everything left of a display column, or below a row.
test::TestSource half_plane(bool rows) {
  test::TestSource source;
  for (const mesh::Vec3& at : {mesh::Vec3(-1000, -1000, 0), mesh::Vec3(0, -1000, 0), mesh::Vec3(0, 1000, 0), mesh::Vec3(-1000, 1000, 0)})
    source.add_node(rows ? mesh::Vec3(at.y(), at.x(), 0) : at);
  source.add_shell(0, 1, 2, 3, 0);
  return source;
}

TEST_F(Weave, every_column_shows_the_scene_at_its_position) {
  show(half_plane(false));
  struct Case {
    const char* profile;
    Vec3 head;
    double slack;  ///< max distance in pixels of a column from its window
  };
  for (const Case& c :
       {Case{"prism-mask-columns", {0, 0, 650}, 0}, Case{"prism-mask-stencil", {0, 0, 650}, 0}, Case{"mono", {0, 0, 650}, 0},
        Case{"prism-mask", {0, 0, 650}, 0.1}, Case{"prism-mask", {90, 40, 560}, 0.8}, Case{"lenticular", {-40, 0, 700}, 0.8}})
    for (const int width : {256, 255})
      for (const bool swap : {false, true}) {
        int wrong = 0;
        for (double edge = 100.05; edge < 112; edge += 0.2) {
          Picture picture;
          picture.profile = *stereo::find_profile(c.profile);
          picture.profile.swap_eyes = swap;
          picture.between_eyes_mm = c.head;
          picture.element_edges = picture.outlines = false;
          picture.view.pan_mm = {(edge - 0.5 * width) * picture.profile.optics.pixel_pitch_mm, 0};
          const Image image = draw(picture, width, 4);
          for (int x = 0; x < width; ++x)
            if (std::abs(x + 0.5 - edge) > c.slack) wrong += (brightness(image, x, 2) > 140) != (x + 0.5 < edge);
        }
        EXPECT_EQ(wrong, 0) << c.profile << " " << c.head.transpose() << " width " << width << ", swapped " << swap;
      }
}

TEST_F(Weave, every_row_shows_the_scene_at_its_position) {
  show(half_plane(true));
  for (const int height : {256, 255}) {
    int wrong = 0;
    for (double edge = 100.05; edge < 112; edge += 0.2) {
      Picture picture;
      picture.profile = *stereo::find_profile("row-interlaced");
      picture.element_edges = picture.outlines = false;
      picture.view.pan_mm = {0, (0.5 * height - edge) * picture.profile.optics.pixel_pitch_mm};
      const Image image = draw(picture, 4, height);
      for (int y = 0; y < height; ++y) wrong += (brightness(image, 2, y) > 140) != (y + 0.5 > edge);
    }
    EXPECT_EQ(wrong, 0) << height;
  }
}

/// Number of connected pieces (8 neighbours) of the pixels that differ from the ground by at least a quarter of the max difference.
int pieces(const std::vector<int>& image, const std::vector<int>& ground, int width, int height) {
  std::vector<char> ink(image.size());
  int strongest = 0;
  for (std::size_t i = 0; i < ink.size(); ++i) strongest = std::max(strongest, std::abs(image[i] - ground[i]));
  for (std::size_t i = 0; i < ink.size(); ++i) ink[i] = 4 * std::abs(image[i] - ground[i]) > strongest;
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
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx)
          if (char& cell = ink[static_cast<std::size_t>(ny) * width + nx]; cell != 0) {
            cell = 0;
            open.push(static_cast<std::size_t>(ny) * width + nx);
          }
    }
  }
  return found;
}

/// What one eye sees of a woven picture, one value for each window, from the subpixels that show it by the optics.
struct EyesShare {
  int width = 0, height = 0;
  std::vector<int> light;
};
EyesShare share_of(const Image& image, const Picture& picture, Eye eye) {
  drivers::display::MaskOptics optics = picture.profile.optics;
  optics.panel_columns = image.width;
  const double mask = picture.profile.mask_moves ? mask_position_mm(optics, picture.between_eyes_mm) : 0;
  const stereo::EyePair eyes = drivers::display::eyes_from(picture.between_eyes_mm, 63);
  const int lowest = -image.width, windows = 2 * image.width;
  EyesShare share{windows, image.height, std::vector<int>(static_cast<std::size_t>(windows) * image.height)};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const double u = (x + 0.5 + colour_offset(picture.profile, channel) - 0.5 * image.width) * optics.pixel_pitch_mm;
        const double v = (0.5 * image.height - y - 0.5) * optics.pixel_pitch_mm;
        const double own = window_number(optics, eyes.of(eye), mask, u, v);
        const double other = window_number(optics, eyes.of(eye == Eye::left ? Eye::right : Eye::left), mask, u, v);
        if (std::abs(own - std::round(own)) < std::abs(other - std::round(other)))
          share.light[static_cast<std::size_t>(y) * windows + static_cast<std::size_t>(std::lround(own) - lowest)] +=
              image.at(x, y)[channel] / 3;
      }
  return share;
}

/// Two sheets that meet at a line through the picture's middle; their other edges are far outside.
test::TestSource seam(double angle, std::uint64_t key) {
  test::TestSource source;
  const mesh::Vec3 along(std::cos(angle) * 400, std::sin(angle) * 400, 0), across(-along.y(), along.x(), 0), middle(0.13, 0.07, 0);
  const std::uint32_t a = source.add_node(middle - along), b = source.add_node(middle + along);
  for (const double side : {1.0, -1.0})
    source.add_shell(a, b, source.add_node(middle + along + side * across), source.add_node(middle - along + side * across), 0);
  source.key = key;
  return source;
}

TEST_F(Weave, a_thin_line_is_one_piece_for_each_eye_at_every_position) {
  constexpr int kWidth = 200, kHeight = 120;
  std::uint64_t key = 10;
  for (const char* name : {"prism-mask", "lenticular", "prism-mask-stencil"})
    for (const Vec3& head : {Vec3(0, 0, 650), Vec3(60, 20, 600), Vec3(-90, 0, 720)}) {
      Picture picture;
      picture.profile = *stereo::find_profile(name);
      if (picture.profile.weave == stereo::Weave::stencil && head.x() != 0) continue;
      picture.between_eyes_mm = head;
      picture.outlines = false;
      int worst = 0;
      for (int degrees = 0; degrees < 180; degrees += 6) {
        show(seam((degrees + 0.37) * std::numbers::pi / 180, ++key));
        picture.element_edges = false;
        const EyesShare ground = share_of(draw(picture, kWidth, kHeight), picture, Eye::left);
        picture.element_edges = true;
        const EyesShare line = share_of(draw(picture, kWidth, kHeight), picture, Eye::left);
        worst = std::max(worst, pieces(line.light, ground.light, line.width, line.height));
      }
      if (picture.profile.weave == stereo::Weave::stencil)
        EXPECT_GT(worst, 3) << "the stencil breaks lines";
      else
        EXPECT_EQ(worst, 1) << name << ", head at " << head.transpose();
    }
}

TEST_F(Weave, an_eyes_columns_look_like_its_own_picture) {
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

TEST_F(Weave, the_rubber_band_has_no_parallax) {
  for (const auto& [name, head] : {std::pair("prism-mask", Vec3(0, 0, 650)), std::pair("prism-mask", Vec3(80, -30, 580)),
                                   std::pair("lenticular", Vec3(20, 0, 650)), std::pair("prism-mask-columns", Vec3(0, 0, 650))}) {
    Picture picture;
    picture.profile = *stereo::find_profile(name);
    picture.between_eyes_mm = head;
    const Image ground = draw(picture, 200, 120);
    picture.rubber_band = PixelRect{150, 90, 40, 20};
    const Image image = draw(picture, 200, 120);
    for (const int x : {90, 91}) {
      EXPECT_GT(brightness(image, x, 20), brightness(ground, x, 20) + 60) << "upper side, column " << x << " " << name;
      EXPECT_GT(brightness(image, x, 90), brightness(ground, x, 90) + 40) << "lower side " << name;
      EXPECT_GT(brightness(image, x, 50), brightness(ground, x, 50)) << "slightly lighter inside " << name;
      EXPECT_EQ(brightness(image, x, 10), brightness(ground, x, 10));
    }
    for (const int x : {40, 150})
      EXPECT_GT(std::max(brightness(image, x, 50), brightness(image, x - 1, 50)), brightness(ground, x, 50) + 30)
          << "column " << x << " " << name;
    for (const int x : {20, 21, 170, 171}) EXPECT_EQ(brightness(image, x, 50), brightness(ground, x, 50)) << name;
  }
}

TEST_F(Weave, without_depth_both_eyes_see_the_mono_picture) {
  constexpr int kWidth = 320, kHeight = 180;
  show(test::make_crash_box());
  Picture mono = fitted("mono", "iso", kWidth, kHeight);
  mono.between_eyes_mm = {60, 20, 600};
  const Image plain = draw(mono, kWidth, kHeight);
  for (const auto& profile : stereo::built_in_profiles()) {
    if (!profile.stereo()) continue;
    Picture picture = mono;
    picture.profile = profile;
    picture.depth_share = 0;
    int images = 0;
    picture.overlay = [&](const EyeImage&) { ++images; };
    const Image image = draw(picture, kWidth, kHeight);
    EXPECT_EQ(images, 1) << profile.name << ": drawn once, not twice";
    EXPECT_EQ(image.rgb == plain.rgb, profile.interlaced()) << profile.name;
    for (int x = 0; profile.weave == stereo::Weave::side_by_side && x < kWidth / 2; ++x)
      ASSERT_EQ(brightness(image, x, 90), brightness(image, x + kWidth / 2, 90)) << x;
    picture.depth_share = 0.5;
    EXPECT_NE(draw(picture, kWidth, kHeight).rgb, image.rgb) << profile.name << ": some depth is not none";
  }
}

TEST_F(Weave, crosstalk_added_to_the_compensated_picture_gives_the_wanted_one) {
  const auto light = [](double value) { return std::pow(value / 255, 2.2); };
  for (const char* name : {"prism-mask", "prism-mask-columns", "prism-mask-stencil", "row-interlaced", "side-by-side"})
    for (const auto& [left, right] :
         {std::pair(1.0F, 0.0F), std::pair(0.0F, 1.0F), std::pair(0.8F, 0.3F), std::pair(0.25F, 0.6F), std::pair(1.0F, 1.0F)}) {
      Picture picture = flooded(name, left, right);
      picture.profile.crosstalk = {0.05, 0.08};
      const Image image = draw(picture, 64, 20);
      const bool rows = picture.profile.weave == stereo::Weave::rows, beside = picture.profile.weave == stereo::Weave::side_by_side;
      const double shown_left = light(image.at(beside ? 4 : 30, 10)[1]);
      const double shown_right = light(rows ? image.at(30, 11)[1] : image.at(beside ? 50 : 31, 10)[1]);
      const double seen_left = shown_left + 0.05 * shown_right, seen_right = shown_right + 0.08 * shown_left;
      // Black can't be darker than the leak, which is added to all values. Rounding costs half a level of 255.
      EXPECT_NEAR(seen_left, 0.05 + 0.95 * light(std::round(left * 255)), 0.006) << name << " " << left << " " << right;
      EXPECT_NEAR(seen_right, 0.08 + 0.92 * light(std::round(right * 255)), 0.006) << name << " " << left << " " << right;
    }
}

TEST_F(Weave, the_compensation_uses_the_other_eyes_light_at_the_same_position) {
  Picture picture = numbered("prism-mask-columns");
  const Image plain = draw(picture, 64, 4);
  picture.profile.crosstalk = {0.1, 0.1};
  const Image image = draw(picture, 64, 4);
  const auto light = [](double value) { return std::pow(value / 255, 2.2); };
  const auto wanted = [&](int x, int channel) { return 0.1 + 0.9 * light(plain.at(x, 1)[channel]); };
  for (int x = 1; x < 63; ++x)
    for (int channel = 0; channel < 3; ++channel) {
      // Midway between the values of the two neighbours.
      const double other = 0.5 * (plain.at(x - 1, 1)[channel] + plain.at(x + 1, 1)[channel]);
      const double corrected = std::clamp((wanted(x, channel) - 0.1 * (0.1 + 0.9 * light(other))) / (1 - 0.01), 0.0, 1.0);
      EXPECT_NEAR(image.at(x, 1)[channel], 255 * std::pow(corrected, 1 / 2.2), 0.8) << x;
    }
}

}  // namespace
}  // namespace prismesh::kiosk::render
