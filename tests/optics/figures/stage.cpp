#include "tests/optics/figures/stage.h"

#include <utility>

#include <GLES3/gl31.h>

#include "kiosk/render/offscreen.h"

namespace prismesh::optics {

using kiosk::render::EyeImage;
using kiosk::render::Picture;

Stage::Stage(kiosk::display::Headless headless, std::unique_ptr<kiosk::render::Renderer> renderer)
    : headless_(std::move(headless)), renderer_(std::move(renderer)) {}

Result<std::unique_ptr<Stage>> Stage::create() {
  Result<kiosk::display::Headless> headless = kiosk::display::Headless::create();
  if (!headless) return fail(headless.error());
  auto renderer = kiosk::render::Renderer::create({});
  if (!renderer) return fail(renderer.error());
  return std::unique_ptr<Stage>(new Stage(std::move(*headless), std::move(*renderer)));
}

void Stage::show(test::TestSource source) {
  source.key = ++key_;
  // A model of a few hundred shells always fits on the GPU.
  [[maybe_unused]] const Result<void> shown = renderer_->set_model(std::make_shared<test::TestSource>(std::move(source)));
}

Result<Picture> Stage::fitted(const std::string& profile, const mesh::Vec3& between_mm, const viewer::Panel& panel) const {
  auto found = kiosk::stereo::find_profile(profile);
  if (!found) return fail(found.error());
  Picture picture;
  picture.profile = *found;
  picture.between_eyes_mm = between_mm;
  picture.view.rotation = *kiosk::stereo::named_rotation("iso");
  picture.view.bounds = kiosk::stereo::sphere_around(renderer_->bounds());
  picture.view = renderer_->fitted(picture.view, {panel.width_mm(), panel.height_mm()}, between_mm.z());
  return picture;
}

Result<viewer::LightImage> Stage::draw(const Picture& picture, const viewer::Panel& panel) {
  Result<kiosk::render::Offscreen> offscreen = kiosk::render::Offscreen::create(panel.columns, panel.rows);
  if (!offscreen) return fail(offscreen.error());
  const auto report = renderer_->draw(picture, offscreen->framebuffer(), panel.columns, panel.rows);
  if (!report) return fail(report.error());
  const kiosk::render::Image image = offscreen->read();
  return viewer::light_of(image.rgb, image.width, image.height);
}

Result<viewer::LightImage> Stage::draw_as(const std::string& profile, Picture picture, const viewer::Panel& panel) {
  auto found = kiosk::stereo::find_profile(profile);
  if (!found) return fail(found.error());
  picture.profile = *found;
  return draw(picture, panel);
}

Result<viewer::Owners> Stage::owners(Picture picture, const viewer::Panel& panel) {
  std::array<viewer::LightImage, 2> lit;
  for (const bool left : {true, false}) {
    picture.overlay = [left](const EyeImage& image) {
      const float light = (image.eye == kiosk::stereo::Eye::left) == left ? 1.0F : 0.0F;
      glDisable(GL_SCISSOR_TEST);
      glClearColor(light, light, light, 1);
      glClear(GL_COLOR_BUFFER_BIT);
    };
    Result<viewer::LightImage> drawn = draw(picture, panel);
    if (!drawn) return fail(drawn.error());
    lit[left ? 0 : 1] = std::move(*drawn);
  }
  return viewer::owners_of(panel, lit[0], lit[1]);
}

viewer::Eyes eyes_of(const Picture& picture) {
  const auto point = [](const mesh::Vec3& at) { return viewer::Point{at.x(), at.y(), at.z()}; };
  return viewer::eyes_around(point(picture.between_eyes_mm), picture.eye_separation_mm, point(picture.toward_right));
}

viewer::MaskDisplay station_display(int columns, int rows) {
  viewer::MaskDisplay display;
  display.panel.columns = columns;
  display.panel.rows = rows;
  return display;
}

}  // namespace prismesh::optics
