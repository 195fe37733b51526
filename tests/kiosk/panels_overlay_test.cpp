// Panels and pointer lie in the screen's plane: whatever the display, they show at their own pixels of the woven picture, for both eyes.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "kiosk/panels/gui.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

class Overlay : public RenderTest {};

/// Pixels whose picture differs.
struct Changed {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  bool operator==(const Changed&) const = default;
};
Changed changed(const Image& image, const Image& ground) {
  Changed box;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (std::abs(brightness(image, x, y) - brightness(ground, x, y)) > 20) {
        box.left = std::min(box.left, x);
        box.right = std::max(box.right, x);
        box.top = std::min(box.top, y);
        box.bottom = std::max(box.bottom, y);
      }
  return box;
}

TEST_F(Overlay, the_pointer_is_where_it_points_on_every_display) {
  constexpr int kWidth = 320, kHeight = 200;
  auto gui = panels::Gui::create();
  ASSERT_TRUE(gui) << gui.error().text();
  ASSERT_TRUE(gui->set_type(panels::kStereoType));
  for (int round = 0; round < 2; ++round) gui->layout({kWidth, kHeight}, 0.016, [] { panels::draw_pointer(200, 40); });
  const auto drawn = [&](const stereo::Profile& profile, const Vec3& head) {
    Picture picture;
    picture.profile = profile;
    picture.between_eyes_mm = head;
    const Image ground = draw(picture, kWidth, kHeight);
    picture.overlay = [&](const EyeImage& image) { gui->draw({image.width, image.height}, image.from_picture); };
    return changed(draw(picture, kWidth, kHeight), ground);
  };
  const Changed wanted = drawn(*stereo::find_profile("mono"), {0, 0, 650});
  ASSERT_LT(std::abs(wanted.left - 200), 5) << "the pointer's tip; its thin end may be invisible";
  ASSERT_LT(std::abs(wanted.top - 40), 5);
  for (const auto& profile : stereo::built_in_profiles())
    for (const Vec3& head : {Vec3(0, 0, 650), Vec3(90, -50, 570)}) {
      if (profile.weave == stereo::Weave::side_by_side || profile.weave == stereo::Weave::top_bottom) continue;  // each half has one
      const Changed box = drawn(profile, head);
      EXPECT_LE(std::abs(box.left - wanted.left), 2) << profile.name << " " << head.transpose();
      EXPECT_LE(std::abs(box.right - wanted.right), 2) << profile.name << " " << head.transpose();
      EXPECT_LE(std::abs(box.top - wanted.top), 2) << profile.name;
      EXPECT_LE(std::abs(box.bottom - wanted.bottom), 2) << profile.name;
    }
}

}  // namespace
}  // namespace prismesh::kiosk::render
