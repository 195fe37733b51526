#include "kiosk/toolkit/view_glide.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::toolkit {

stereo::View ViewGlide::along(const stereo::View& view, std::int64_t now_ns) {
  if (!way_) return view;
  const auto left = [&](std::int64_t at_ns) {
    const double t = std::clamp(static_cast<double>(at_ns - way_->begun_ns) / static_cast<double>(kGlideNs), 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
  };
  const double before = left(way_->last_ns), after = left(now_ns);
  const double share = before > 0 ? 1 - after / before : 1;
  stereo::View moved = stereo::with_pivot(view, way_->point);
  moved.pan_mm *= 1 - share;
  moved.before_mm *= 1 - share;
  moved.mm_per_unit *= std::pow(way_->mm_per_unit / moved.mm_per_unit, share);
  way_->last_ns = now_ns;
  if (after <= 0) way_.reset();
  return moved;
}

double scale_to_look_at(double length, double now_mm_per_unit, double mm_per_pixel, double wanted_pixels) {
  const double pixels = length * now_mm_per_unit / mm_per_pixel;
  const bool fits = pixels >= 0.5 * wanted_pixels && pixels <= 4 * wanted_pixels;
  return fits || !(length > 0) ? now_mm_per_unit : wanted_pixels * mm_per_pixel / length;
}

}  // namespace prismesh::kiosk::toolkit
