// Shared by the optics tests: the kiosk's renderer weaves, the simulated viewer looks. The viewer's display is defined here from the
// profile's documented meaning, independently of the renderer's optics.
#pragma once

#include <string>
#include <vector>

#include <GLES3/gl31.h>

#include "tests/kiosk/render_test.h"
#include "tests/viewer/other_displays.h"
#include "tests/viewer/owners.h"
#include "tests/viewer/seen.h"

namespace prismesh::optics {

using kiosk::render::EyeImage;
using kiosk::render::Image;
using kiosk::render::Picture;
using mesh::Vec3;

inline viewer::Point point(const Vec3& at) { return {at.x(), at.y(), at.z()}; }

class OpticsTest : public kiosk::render::RenderTest {
 protected:
  /// The station's display according to its data sheet, with a panel of so many pixels.
  static viewer::MaskDisplay display(int columns, int rows) {
    viewer::MaskDisplay made;
    made.panel.columns = columns;
    made.panel.rows = rows;
    return made;
  }
  static viewer::LightImage light(const Image& image) { return viewer::light_of(image.rgb, image.width, image.height); }

  /// The picture on the panel.
  viewer::LightImage woven(const Picture& picture, const viewer::Panel& panel) { return light(draw(picture, panel.columns, panel.rows)); }
  /// The same scene and eyes on an ordinary screen.
  viewer::LightImage ordinary(const Picture& picture, const char* profile, const viewer::Panel& panel) {
    Picture other = picture;
    other.profile = profile_named(profile);
    other.mask_mm.reset();
    return woven(other, panel);
  }

  /// The woven picture of plain eye images: white for one eye, black for the other.
  viewer::LightImage lit(const Picture& picture, bool left, const viewer::Panel& panel) {
    Picture plain = picture;
    plain.overlay = [left](const EyeImage& image) {
      const float light = (image.eye == kiosk::stereo::Eye::left) == left ? 1.0F : 0.0F;
      glDisable(GL_SCISSOR_TEST);
      glClearColor(light, light, light, 1);
      glClear(GL_COLOR_BUFFER_BIT);
    };
    return woven(plain, panel);
  }
  viewer::Owners owners(const Picture& picture, const viewer::Panel& panel) {
    const auto found = viewer::owners_of(panel, lit(picture, true, panel), lit(picture, false, panel));
    EXPECT_TRUE(found);
    return *found;
  }

  static Picture at_head(const std::string& profile, const Vec3& between_mm) {
    Picture picture;
    picture.profile = profile_named(profile);
    picture.between_eyes_mm = between_mm;
    return picture;
  }
  /// Fills the screen with the model, as seen from the eyes' position.
  void fit(Picture& picture, const viewer::Panel& panel) const {
    const Picture framed = fitted("mono", "iso", panel.columns, panel.rows);
    picture.view = framed.view;
  }
  static decltype(Picture::profile) profile_named(const std::string& name) {
    auto found = kiosk::stereo::find_profile(name);
    EXPECT_TRUE(found) << name;
    return *found;
  }
  static viewer::Eyes eyes_of(const Picture& picture) {
    return viewer::eyes_around(point(picture.between_eyes_mm), picture.eye_separation_mm, point(picture.toward_right));
  }
  static std::vector<int> some_rows(const viewer::Panel& panel) { return {0, panel.rows / 2, panel.rows - 1}; }
};

}  // namespace prismesh::optics
