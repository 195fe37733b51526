// Where shells touch: the alerting texture, crossing curves and ways out, and what a drag comes to touch.
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "kiosk/render/contact_pass.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using ipc::SnapshotArray;
using mesh::Vec3;
using test::TestSource;
using test::two_plates;

constexpr int kContactWidth = 640, kContactHeight = 400;
/// The front plate's shells come first.
constexpr std::size_t kPlateShells = 100;

std::vector<mesh::ShellIndex> shells_from(std::size_t first, std::size_t count) {
  std::vector<mesh::ShellIndex> shells;
  for (std::size_t s = first; s < first + count; ++s) shells.emplace_back(s);
  return shells;
}

bool is_alert_bright(const std::uint8_t* p) { return p[0] > 130 && p[1] > 105 && p[2] < p[1] / 2; }
bool is_alert_dark(const std::uint8_t* p) { return p[0] < 40 && p[1] < 40 && p[2] < 45; }
bool is_red(const std::uint8_t* p) { return p[0] > 150 && p[1] < 90 && p[2] < 90; }

class ContactPictures : public RenderTest {
 protected:
  Picture plain(const char* profile = "mono") const {
    Picture picture = fitted(profile, "top", kContactWidth, kContactHeight);
    picture.element_edges = picture.outlines = false;
    return picture;
  }
  void mark(const ContactPicture& contact) {
    const auto set = renderer_->set_contact(contact);
    ASSERT_TRUE(set) << set.error().text();
  }
  Image drawn(const Picture& picture) { return draw(picture, kContactWidth, kContactHeight); }
  Eigen::Vector2d pixel_of(const Picture& picture, const Vec3& point) const {
    return *stereo::pixel_of(aim_of(picture, kContactWidth, kContactHeight), point);
  }
  struct Stripes {
    std::size_t bright = 0, dark = 0, all = 0;
  };
  /// About a plate's middle.
  Stripes stripes(const Image& image, const Picture& picture, double z) const {
    Stripes found;
    const Eigen::Vector2d a = pixel_of(picture, {-20, 10, z}), b = pixel_of(picture, {20, -10, z});
    for (int y = static_cast<int>(a.y()); y < static_cast<int>(b.y()); ++y)
      for (int x = static_cast<int>(a.x()); x < static_cast<int>(b.x()); ++x) {
        ++found.all;
        if (is_alert_bright(image.at(x, y))) ++found.bright;
        if (is_alert_dark(image.at(x, y))) ++found.dark;
      }
    return found;
  }
};

TEST_F(ContactPictures, touching_shells_are_striped_and_others_are_not) {
  show(two_plates());
  const Picture picture = plain();
  const Image without = drawn(picture);
  mark({{}, shells_from(0, kPlateShells / 2), {}, {}});
  const Image marked = drawn(picture);
  const Eigen::Vector2d half = pixel_of(picture, {0, 0, 20});
  Stripes lower, upper;
  for (int y = 0; y < kContactHeight; ++y)
    for (int x = static_cast<int>(half.x()) - 80; x < static_cast<int>(half.x()) + 80; ++x) {
      Stripes& side = y > static_cast<int>(half.y()) + 2 ? lower : upper;
      ++side.all;
      if (is_alert_bright(marked.at(x, y))) ++side.bright;
      if (is_alert_dark(marked.at(x, y))) ++side.dark;
      if (y < static_cast<int>(half.y()) - 2) {
        EXPECT_EQ(brightness(marked, x, y), brightness(without, x, y)) << x << ", " << y;
      }
    }
  EXPECT_GT(lower.bright, 2000u);
  EXPECT_GT(lower.dark, 2000u);
  EXPECT_LT(upper.bright, 400u);
  mark({});
  const Image cleared = drawn(picture);
  for (int y = 0; y < kContactHeight; y += 3)
    for (int x = 0; x < kContactWidth; x += 3) ASSERT_EQ(brightness(cleared, x, y), brightness(without, x, y));
}

TEST_F(ContactPictures, stripes_show_without_colours_and_keep_their_width_about) {
  show(two_plates());
  Picture picture = plain();
  mark({{}, shells_from(0, kPlateShells), {}, {}});
  for (const double zoom : {1.0, 1.7, 2.9, 5.0}) {
    Picture zoomed = picture;
    zoomed.view = stereo::zoom(picture.view, zoom, {0, 0});
    const Image image = drawn(zoomed);
    const Eigen::Vector2d middle = pixel_of(zoomed, {0, 0, 20});
    const auto row = static_cast<int>(middle.y());
    int changes = 0, least = 255, most = 0;
    bool bright = brightness(image, static_cast<int>(middle.x()) - 90, row) > 90;
    for (int x = static_cast<int>(middle.x()) - 90; x < static_cast<int>(middle.x()) + 90; ++x) {
      const int here = brightness(image, x, row);
      least = std::min(least, here), most = std::max(most, here);
      if ((here > 90) != bright) ++changes, bright = !bright;
    }
    EXPECT_LT(least, 40) << zoom;
    EXPECT_GT(most, 130) << "in grey they are as far apart";
    EXPECT_GE(changes, 180 / 26) << zoom;  // across the row a stripe is sqrt(2) as wide
    EXPECT_LE(changes, 180 / 7) << zoom;
  }
}

TEST(StripePeriod, is_a_power_of_two_in_the_model) {
  for (const double mm_per_unit : {1e-3, 0.1, 0.77, 1.0, 3.3, 250.0}) {
    const double period = stripe_period(mm_per_unit, 0.28), pixels = period * mm_per_unit / 0.28;
    EXPECT_GE(pixels, 2 * kStripePixels * (1 - 1e-12));
    EXPECT_LE(pixels, 4 * kStripePixels);
    EXPECT_EQ(std::exp2(std::round(std::log2(period))), period);
  }
}

TEST_F(ContactPictures, stripes_lie_on_the_surface_for_both_eyes) {
  show(two_plates());
  Picture picture = plain("side-by-side");
  picture.view.depth_strength = 1.5;
  mark({shells_from(0, kPlateShells), {}, {}, {}});
  const Image image = drawn(picture);
  const stereo::PictureEyes eyes{picture.between_eyes_mm, picture.toward_right, picture.eye_separation_mm, 1};
  int same = 0, other = 0, bright = 0;
  double parallax = 0;
  for (double x = -40; x <= 40; x += 0.7)
    for (double y = -20; y <= 20; y += 1.3) {
      std::array<bool, 2> is_bright{};
      std::array<double, 2> at{};
      for (const stereo::Eye eye : {stereo::Eye::left, stereo::Eye::right}) {
        const bool right = eye == stereo::Eye::right;
        stereo::Aim aim = aim_of(picture, kContactWidth, kContactHeight);
        aim.eye_mm = eyes.picture_eye(eye);
        const Eigen::Vector2d pixel = *stereo::pixel_of(aim, {x, y, 20});
        at[right ? 1 : 0] = pixel.x();
        is_bright[right ? 1 : 0] =
            brightness(image, static_cast<int>(pixel.x() / 2) + (right ? kContactWidth / 2 : 0), static_cast<int>(pixel.y())) > 85;
      }
      parallax = std::max(parallax, std::abs(at[1] - at[0]));
      ++(is_bright[0] == is_bright[1] ? same : other);
      bright += is_bright[0] ? 1 : 0;
    }
  EXPECT_GT(parallax, 3) << "the eyes see the plate in different places";
  EXPECT_GT(bright, (same + other) / 4);
  EXPECT_LT(bright, 3 * (same + other) / 4);
  EXPECT_GT(same, 8 * other) << "but the same stripes on it";
}

TEST_F(ContactPictures, the_chosen_region_shows_through_what_hides_it) {
  show(two_plates());
  const Picture picture = plain();
  const Image without = drawn(picture);
  mark({{}, shells_from(kPlateShells, kPlateShells), {}, {}});
  const Stripes other = stripes(drawn(picture), picture, 20);
  EXPECT_EQ(other.bright + other.dark, 0u) << "the front plate hides it";
  mark({shells_from(kPlateShells, kPlateShells), {}, {}, {}});
  const Image chosen = drawn(picture);
  int differ = 0;
  for (int y = 180; y < 220; ++y)
    for (int x = 280; x < 360; ++x) differ += std::abs(brightness(chosen, x, y) - brightness(without, x, y)) > 12 ? 1 : 0;
  EXPECT_GT(differ, 40 * 80 / 4);
}

TEST_F(ContactPictures, curves_and_ways_out_are_drawn) {
  show(two_plates());
  const Picture picture = plain();
  mark({{}, shells_from(0, kPlateShells), {{Vec3(-40, 0, 20.5), Vec3(40, 0, 20.5)}}, {{Vec3(0, -25, 20.5), Vec3(0, -10, 20.5)}}});
  const Image image = drawn(picture);
  int on_curve = 0, on_way = 0;
  for (double x = -38; x <= 38; x += 1) {
    const Eigen::Vector2d at = pixel_of(picture, {x, 0, 20.5});
    on_curve += is_red(image.at(static_cast<int>(at.x()), static_cast<int>(at.y()))) ? 1 : 0;
  }
  for (double y = -24; y <= -11; y += 1) {
    const Eigen::Vector2d at = pixel_of(picture, {0, y, 20.5});
    const std::uint8_t* p = image.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
    on_way += p[2] > 150 && p[2] > p[0] + 40 ? 1 : 0;
  }
  EXPECT_GE(on_curve, 70) << "of 77";
  EXPECT_GE(on_way, 10) << "of 14";
}

TEST_F(ContactPictures, shells_of_hidden_parts_and_beyond_the_model_are_left_out) {
  TestSource source = two_plates();
  show(source);
  const Picture picture = plain();
  std::vector<mesh::ShellIndex> shells = shells_from(0, 2 * kPlateShells);
  shells.emplace_back(std::size_t{5000});
  shells.emplace_back();
  mark({{}, shells, {}, {}});
  EXPECT_GT(stripes(drawn(picture), picture, 20).bright, 500u);
  source.hidden[0] = source.hidden[1] = true;
  show(source);
  const Stripes none = stripes(drawn(picture), picture, 20);
  EXPECT_EQ(none.bright + none.dark, 0u);
  source.hidden[0] = source.hidden[1] = false;
  show(source);
  EXPECT_GT(stripes(drawn(picture), picture, 20).bright, 500u) << "they come back";
  source.add_shell(0, 1, 12, 11, 0);
  source.touch(SnapshotArray::shell_nodes, 0);
  show(source);
  EXPECT_EQ(stripes(drawn(picture), picture, 20).bright, 0u) << "other shells: the marks are of the old ones";
}

TEST_F(ContactPictures, what_a_drag_touches_is_striped_until_its_end) {
  const TestSource source = two_plates();
  show(source);
  const Picture picture = plain();
  const Image without = drawn(picture);
  std::vector<mesh::NodeIndex> nodes;
  ipc::PreviewFrame frame;
  for (std::size_t n = 0; n < 121; ++n) {
    nodes.emplace_back(n);
    frame.positions.push_back(source.positions[n] + Vec3(0, 0, 4));
  }
  const std::vector<mesh::ShellIndex> shells = shells_from(0, kPlateShells);
  frame.states.resize(shells.size());
  frame.sequence = 1;
  renderer_->begin_preview(nodes, shells);
  ASSERT_TRUE(renderer_->update_preview(frame));
  EXPECT_EQ(stripes(drawn(picture), picture, 24).bright, 0u) << "nothing touches yet";
  frame.sequence = 2;
  frame.touches.parts = 2;
  frame.touches.moved = {~std::uint64_t{0}, ~std::uint64_t{0}};
  ASSERT_TRUE(renderer_->update_preview(frame));
  const Stripes moved = stripes(drawn(picture), picture, 24);
  EXPECT_GT(moved.bright, moved.all / 4);
  EXPECT_GT(moved.dark, moved.all / 4);
  frame.sequence = 3;
  frame.touches = {};
  frame.touches.others = shells_from(0, kPlateShells);
  ASSERT_TRUE(renderer_->update_preview(frame));
  EXPECT_GT(stripes(drawn(picture), picture, 20).bright, 500u) << "what is touched, too";
  ASSERT_TRUE(renderer_->update_preview([&] {
    frame.sequence = 4;
    frame.touches.moved = {~std::uint64_t{0}, ~std::uint64_t{0}};
    return frame;
  }()));
  renderer_->end_preview();
  const Image after = drawn(picture);
  for (int y = 0; y < kContactHeight; y += 3)
    for (int x = 0; x < kContactWidth; x += 3) ASSERT_EQ(brightness(after, x, y), brightness(without, x, y));
}

}  // namespace
}  // namespace prismesh::kiosk::render
