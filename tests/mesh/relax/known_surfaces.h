// Meshes on surfaces whose every point is known: cylinder, cone and torus, and the distance from each.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "tests/mesh/spatial/trial_sheets.h"

namespace prismesh::test {

struct KnownSurface {
  std::string name;
  std::function<mesh::Vec3(double, double)> at;  ///< parameters in element sizes
  std::function<double(const mesh::Vec3&)> off;  ///< distance from the surface
  double sagitta = 0;                            ///< of an element: how far its middle is off where its nodes are on it
};

constexpr double kRadius = 50;  ///< element size 5: 18 elements make a quarter's turn and a bit
constexpr double kSize = 5;

inline KnownSurface cylinder() {
  return {"cylinder",
          [](double i, double j) {
            const double angle = i * kSize / kRadius;
            return mesh::Vec3(kRadius * std::cos(angle), kRadius * std::sin(angle), j * kSize);
          },
          [](const mesh::Vec3& p) { return std::abs(std::hypot(p.x(), p.y()) - kRadius); }, kSize * kSize / (8 * kRadius)};
}

/// Opens by 20 degrees.
inline KnownSurface cone() {
  const double slope = 20 * 3.14159265358979 / 180;
  return {"cone",
          [=](double i, double j) {
            const double angle = i * kSize / kRadius, radius = kRadius + j * kSize * std::sin(slope);
            return mesh::Vec3(radius * std::cos(angle), radius * std::sin(angle), j * kSize * std::cos(slope));
          },
          [=](const mesh::Vec3& p) { return std::abs((std::hypot(p.x(), p.y()) - kRadius) * std::cos(slope) - p.z() * std::sin(slope)); },
          kSize * kSize / (8 * kRadius)};
}

/// The outer half of a torus: curved both ways there, like a saddle farther in.
inline KnownSurface torus() {
  const double around = 120;
  return {"torus",
          [=](double i, double j) {
            const double angle = j * kSize / around, turn = (i - 10) * kSize / kRadius;
            const double radius = around + kRadius * std::cos(turn);
            return mesh::Vec3(radius * std::cos(angle), radius * std::sin(angle), kRadius * std::sin(turn));
          },
          [=](const mesh::Vec3& p) { return std::abs(std::hypot(std::hypot(p.x(), p.y()) - around, p.z()) - kRadius); },
          kSize * kSize / (8 * kRadius)};
}

/// A sheet of columns x rows elements on it, its inner nodes moved in it by up to `jitter` of an element.
inline mesh::Model sheet_on(const KnownSurface& surface, int columns, int rows, double jitter) {
  return make_grid(columns, rows, [&](int i, int j) {
    const bool inside = i > 0 && j > 0 && i < columns && j < rows;
    return surface.at(i + (inside ? jitter * noise(i, j, 1) : 0), j + (inside ? jitter * noise(i, j, 2) : 0));
  });
}

}  // namespace prismesh::test
