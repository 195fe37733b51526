#include "kiosk/tools/shaping/falloff_ring.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::tools::shaping {

using input::Pixel;
using mesh::Vec3;

namespace {

constexpr double kReachPixels = 5;
constexpr double kHalf = 0.5;
constexpr double kFlatSteps = 50;  ///< from 0 to 1

}  // namespace

HalfwayLine halfway_line(const ipc::FollowedEdges& answer) {
  HalfwayLine line;
  for (const auto& piece : answer.halfway) line.push_back({Vec3(piece[0], piece[1], piece[2]), Vec3(piece[3], piece[4], piece[5])});
  return line;
}

std::optional<Vec3> ring_at(const stereo::Aim& aim, const HalfwayLine& line, const Pixel& pixel) {
  std::optional<Vec3> nearest;
  double reach = kReachPixels;
  for (const auto& [from, to] : line) {
    const auto a = stereo::pixel_of(aim, from), b = stereo::pixel_of(aim, to);
    if (!a || !b) continue;
    const Pixel way = *b - *a;
    const double length = way.squaredNorm(), share = length > 0 ? std::clamp((pixel - *a).dot(way) / length, 0.0, 1.0) : 0;
    const double away = (pixel - (*a + share * way)).norm();
    if (away > reach) continue;
    reach = away;
    nearest = from + share * (to - from);
  }
  return nearest;
}

std::vector<std::vector<Pixel>> ring_in_picture(const stereo::Aim& aim, const HalfwayLine& line) {
  std::vector<std::vector<Pixel>> lines;
  for (const auto& [from, to] : line) {
    const auto a = stereo::pixel_of(aim, from), b = stereo::pixel_of(aim, to);
    if (a && b) lines.push_back({*a, *b});
  }
  return lines;
}

double halfway_share(const mesh::shape::Falloff& falloff) {
  double low = 0, high = 1;
  if (mesh::shape::evaluate(falloff, low) >= kHalf) return 0;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (mesh::shape::evaluate(falloff, middle) < kHalf ? low : high) = middle;
  }
  return high;
}

RingDrag::RingDrag(const mesh::shape::Falloff& falloff, const Pixel& foot, const Pixel& taken) : foot_(foot) {
  mesh::shape::Falloff without = falloff;
  without.flat = 0;
  halfway_ = halfway_share(without);
  const double to_border = 1 - halfway_share(falloff);  // share of the way from the foot at which it was taken
  border_ = to_border > 0 ? (taken - foot).norm() / to_border : 0;
}

double RingDrag::flat_at(const Pixel& pixel) const {
  if (!(border_ > 0) || !(halfway_ > 0)) return 0;
  const double wanted = 1 - (pixel - foot_).norm() / border_;
  return std::clamp(std::round((1 - wanted / halfway_) * kFlatSteps) / kFlatSteps, 0.0, kFlattest);
}

}  // namespace prismesh::kiosk::tools::shaping
