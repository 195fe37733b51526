#include "kiosk/render/handle_mesh.h"

#include <cmath>
#include <numbers>

namespace prismesh::kiosk::render {

namespace {

constexpr int kSides = 24;
constexpr float kRingOuter = 13.5F, kRingInner = 10.5F;
constexpr float kShaftRadius = 2.6F, kHeadRadius = 8.0F, kHeadStart = 0.72F;

/// One point of the arrow's silhouette, turned about the axis.
struct Profile {
  float along, radius;
};

void add_band(std::vector<HandleVertex>& mesh, const Profile& lower, const Profile& upper, const std::array<float, 2>& slant) {
  const auto vertex = [&](const Profile& point, int side) {
    const double angle = 2 * std::numbers::pi * side / kSides;
    return HandleVertex{{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}, {point.along, point.radius}, slant};
  };
  for (int side = 0; side < kSides; ++side) {
    const HandleVertex a = vertex(lower, side), b = vertex(lower, side + 1), c = vertex(upper, side + 1), d = vertex(upper, side);
    mesh.insert(mesh.end(), {a, b, c, a, c, d});
  }
}

}  // namespace

std::vector<HandleVertex> arrow_mesh() {
  std::vector<HandleVertex> mesh;
  const float head_slope = 0.35F;  // of the head's normal along the axis: how it catches light, not its exact geometry
  add_band(mesh, {0, 0}, {0, kShaftRadius}, {0, -1});
  add_band(mesh, {0, kShaftRadius}, {kHeadStart, kShaftRadius}, {1, 0});
  add_band(mesh, {kHeadStart, kShaftRadius}, {kHeadStart, kHeadRadius}, {0, -1});
  add_band(mesh, {kHeadStart, kHeadRadius}, {1, 0.01F}, {std::sqrt(1 - head_slope * head_slope), head_slope});
  return mesh;
}

std::vector<HandleVertex> ring_mesh() {
  std::vector<HandleVertex> mesh;
  add_band(mesh, {0, kRingOuter}, {1, kRingOuter}, {1, 0});
  add_band(mesh, {1, kRingOuter}, {1, kRingInner}, {0, 1});
  add_band(mesh, {1, kRingInner}, {0, kRingInner}, {-1, 0});
  return mesh;
}

}  // namespace prismesh::kiosk::render
