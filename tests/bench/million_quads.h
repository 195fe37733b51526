// The model that benchmarks are measured on: 1000 x 1000 quads of 5 mm, curved and jittered.
#pragma once

#include <cmath>
#include <cstdint>

#include "mesh/model/model.h"

namespace prismesh::mesh::bench {

/// A part of steel sheet, 1 mm thick; mm, t, s.
inline Part steel_sheet() {
  Part part;
  part.id = 1;
  part.defined = true;
  part.thickness = 1.0;
  part.density = 7.85e-9;
  part.youngs_modulus = 210000.0;
  part.poissons_ratio = 0.3;
  return part;
}

/// Positions and shells only; made once.
inline const Model& million_quads() {
  static const Model model = [] {
    constexpr std::size_t kSide = 1000, kStride = kSide + 1;
    Model m;
    m.positions.resize(kStride * kStride, Vec3::Zero());
    m.shell_nodes.resize(kSide * kSide);
    m.shell_parts.resize(kSide * kSide, PartIndex(std::size_t{0}));
    m.shell_thickness.resize(kSide * kSide);
    std::uint32_t seed = 1;
    const auto jitter = [&] { return ((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5; };
    for (std::size_t j = 0; j < kStride; ++j)
      for (std::size_t i = 0; i < kStride; ++i) {
        const double x = 5.0 * static_cast<double>(i), y = 5.0 * static_cast<double>(j);
        m.positions.set(j * kStride + i,
                        Vec3(x + 1.5 * jitter(), y + 1.5 * jitter(), 300 * std::sin(x / 800) * std::cos(y / 900) + jitter()));
      }
    for (std::size_t j = 0; j < kSide; ++j)
      for (std::size_t i = 0; i < kSide; ++i) {
        const std::size_t a = j * kStride + i;
        m.shell_nodes.set(j * kSide + i, {{NodeIndex(a), NodeIndex(a + 1), NodeIndex(a + kStride + 1), NodeIndex(a + kStride)}});
      }
    m.parts = std::make_shared<const std::vector<Part>>(1, steel_sheet());
    return m;
  }();
  return model;
}

}  // namespace prismesh::mesh::bench
