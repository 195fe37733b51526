#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

std::optional<ColourMode> colour_mode_from(std::string_view name) {
  for (std::size_t i = 0; i < kColourModeNames.size(); ++i)
    if (kColourModeNames[i] == name) return static_cast<ColourMode>(i);
  return std::nullopt;
}

drivers::display::PanelArea panel_area(const PanelPlace& place, int width, int height) {
  if (place.width <= 0 || place.height <= 0) return {0, 0, width, height, width, height};
  return {place.x, place.y, width, height, place.width, place.height};
}

stereo::Aim aim_for(const Picture& picture, int width, int height) {
  stereo::PictureEyes eyes{picture.between_eyes_mm, picture.toward_right, picture.eye_separation_mm, picture.depth_share};
  const drivers::display::PanelArea area = panel_area(picture.panel, width, height);
  const double pitch = picture.profile.optics.pixel_pitch_mm;
  eyes.between_mm -= Vec3(area.u_mm(0.5 * width, pitch), area.v_mm(0.5 * height, pitch), 0);
  return stereo::aim_for(picture.view, picture.profile, eyes, width, height);
}

}  // namespace prismesh::kiosk::render
