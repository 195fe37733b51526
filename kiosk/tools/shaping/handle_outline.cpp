#include "kiosk/tools/shaping/handle_outline.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include "kiosk/toolkit/arrow.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using input::Pixel;
using input::Under;
using mesh::Vec3;

using Lines = std::vector<std::vector<Pixel>>;

constexpr int kRimSteps = 72;

double radians_of_step(int step) { return 2 * std::numbers::pi * step / kRimSteps; }

Lines round_in_screen(const Pixel& middle, double radius) {
  std::vector<Pixel> rim;
  for (int step = 0; step <= kRimSteps; ++step)
    rim.emplace_back(middle + radius * Pixel(std::cos(radians_of_step(step)), std::sin(radians_of_step(step))));
  return {std::move(rim)};
}

/// The circle about an axis (direction: unit) through a point.
Lines round_in_deck(const stereo::Aim& aim, const Vec3& on_axis, const Vec3& direction, const Vec3& through) {
  Lines lines(1);
  for (int step = 0; step <= kRimSteps; ++step) {
    const Vec3 at = on_axis + Eigen::AngleAxisd(radians_of_step(step), direction) * (through - on_axis);
    if (const auto pixel = stereo::pixel_of(aim, at))
      lines.back().push_back(*pixel);
    else if (!lines.back().empty())
      lines.emplace_back();
  }
  return lines;
}

}  // namespace

Lines outline_of_part(const stereo::Aim& aim, const render::Handle& handle, Under part) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, handle.at);
  if (!foot) return {};
  switch (part) {
    case Under::lift_handle: return toolkit::arrow_line(aim, handle.at, handle.direction);
    case Under::move_handle: return round_in_screen(*foot, render::kHandleRingPixels);
    case Under::slide_handle: {
      const Vec3 arrow = stereo::handle_tip(aim, handle.at, handle.direction) - handle.at;
      const double radius = arrow.norm() * render::kHandleDiskPixels / stereo::kHandleLengthPixels;
      return round_in_deck(aim, handle.at, handle.direction, handle.at + radius * handle.direction.unitOrthogonal());
    }
    case Under::turn_handle: {
      if (!handle.turn) return {};
      Lines lines = round_in_deck(aim, handle.turn->point, handle.turn->axis, handle.at);
      lines.push_back(round_in_screen(*foot, render::kHandleBallPixels).front());
      return lines;
    }
    default: return {};
  }
}

}  // namespace prismesh::kiosk::tools::shaping
