// The source of the figures' pictures: the kiosk's renderer without a screen, and a simulated viewer.
#pragma once

#include <memory>
#include <string>

#include "kiosk/display/headless.h"
#include "kiosk/render/renderer.h"
#include "tests/kiosk/test_source.h"
#include "tests/viewer/owners.h"
#include "tests/viewer/seen.h"

namespace prismesh::optics {

class Stage {
 public:
  /// Errors: no EGL, no OpenGL ES.
  static Result<std::unique_ptr<Stage>> create();

  void show(test::TestSource source);
  /// The model from the front right, filling a panel of this size.
  Result<kiosk::render::Picture> fitted(const std::string& profile, const mesh::Vec3& between_mm, const viewer::Panel& panel) const;
  Result<viewer::LightImage> draw(const kiosk::render::Picture& picture, const viewer::Panel& panel);
  /// The same scene and eyes with another profile.
  Result<viewer::LightImage> draw_as(const std::string& profile, kiosk::render::Picture picture, const viewer::Panel& panel);
  Result<viewer::Owners> owners(kiosk::render::Picture picture, const viewer::Panel& panel);

 private:
  Stage(kiosk::display::Headless headless, std::unique_ptr<kiosk::render::Renderer> renderer);
  kiosk::display::Headless headless_;
  std::unique_ptr<kiosk::render::Renderer> renderer_;
  std::uint64_t key_ = 0;
};

viewer::Eyes eyes_of(const kiosk::render::Picture& picture);
viewer::MaskDisplay station_display(int columns, int rows);

}  // namespace prismesh::optics
