#include "kiosk/toolkit/arrow.h"

#include <optional>

#include "kiosk/render/picture.h"

namespace prismesh::kiosk::toolkit {

bool points_at_viewer(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction) {
  const std::optional<input::Pixel> foot = stereo::pixel_of(aim, at), tip = stereo::pixel_of(aim, stereo::handle_tip(aim, at, direction));
  return !foot || !tip || (*tip - *foot).norm() < 2 * render::kHandleRingPixels;
}

std::vector<std::vector<input::Pixel>> arrow_line(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction) {
  const std::optional<input::Pixel> foot = stereo::pixel_of(aim, at), tip = stereo::pixel_of(aim, stereo::handle_tip(aim, at, direction));
  if (!foot || !tip) return {};
  return {{*foot, *tip}};
}

ArrowPull::ArrowPull(const stereo::Aim& aim, const mesh::Vec3& at, const mesh::Vec3& direction, const input::Pixel& pixel)
    : at_(at), direction_(direction) {
  hold(aim, pixel, 0);
}

void ArrowPull::hold(const stereo::Aim& aim, const input::Pixel& pixel, double distance) {
  taken_ = pixel;
  held_ = distance;
  upward_ = points_at_viewer(aim, foot(distance), direction_) || !stereo::distance_along(aim, at_, direction_, pixel);
  when_taken_ = raw(aim, pixel);
}

double ArrowPull::raw(const stereo::Aim& aim, const input::Pixel& pixel) const {
  if (upward_) return (taken_.y() - pixel.y()) * aim.mm_per_pixel() / aim.view.mm_per_unit;
  return stereo::distance_along(aim, at_, direction_, pixel).value_or(when_taken_);
}

double ArrowPull::distance(const stereo::Aim& aim, const input::Pixel& pixel) const { return held_ + raw(aim, pixel) - when_taken_; }

}  // namespace prismesh::kiosk::toolkit
