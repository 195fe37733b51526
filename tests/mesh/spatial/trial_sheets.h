// Surfaces of some 10,000 elements on which distances and weights are tried; lengths in element sizes.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/make_model.h"

namespace prismesh::test {

/// A number in -1..1 that looks random and is the same in every run.
inline double noise(int i, int j, int which) {
  std::uint32_t h =
      static_cast<std::uint32_t>(i) * 73856093u ^ static_cast<std::uint32_t>(j) * 19349663u ^ static_cast<std::uint32_t>(which) * 83492791u;
  h ^= h >> 13;
  h *= 0x5bd1e995u;
  h ^= h >> 15;
  return static_cast<double>(h % 200001u) / 100000.0 - 1.0;
}

/// Height of a panel 100 wide: a broad bump and a shallow bead across it.
inline double panel_height(double x, double y) {
  const double bump = 9 * std::exp(-((x - 42) * (x - 42) + (y - 55) * (y - 55)) / (2 * 15.0 * 15.0));
  const double bead = 2.5 * std::exp(-(x - 0.4 * y - 40) * (x - 0.4 * y - 40) / (2 * 6.0 * 6.0));
  return bump + bead;
}

inline mesh::Vec3 on_panel(double x, double y) { return {x, y, panel_height(x, y)}; }

/// 100 x 100 places, each moved by up to `jitter`.
inline std::array<double, 2> panel_place(int i, int j, double jitter) { return {i + jitter * noise(i, j, 1), j + jitter * noise(i, j, 2)}; }

inline mesh::Model quad_panel(double jitter) {
  return make_grid(100, 100, [=](int i, int j) {
    const auto [x, y] = panel_place(i, j, jitter);
    return on_panel(x, y);
  });
}

/// Quads, with two triangles in their place wherever chance will.
inline mesh::Model mixed_panel(double jitter, double triangles_share) {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int j = 0; j <= 92; ++j)
    for (int i = 0; i <= 92; ++i) {
      const auto [x, y] = panel_place(i, j, jitter);
      nodes.push_back({1 + i + 93 * j, on_panel(x, y)});
    }
  for (int j = 0; j < 92; ++j)
    for (int i = 0; i < 92; ++i) {
      const std::int64_t a = 1 + i + 93 * j, b = a + 1, d = a + 93, c = d + 1;
      const auto id = static_cast<std::int64_t>(shells.size()) + 1;
      if (0.5 + 0.5 * noise(i, j, 3) >= triangles_share) {
        shells.push_back({id, 1, {a, b, c, d}});
      } else if (noise(i, j, 4) > 0) {
        shells.push_back({id, 1, {a, b, c}});
        shells.push_back({id + 1, 1, {a, c, d}});
      } else {
        shells.push_back({id, 1, {a, b, d}});
        shells.push_back({id + 1, 1, {b, c, d}});
      }
    }
  return make_model(nodes, shells);
}

/// Triangles `aspect` times as long as high, sheared by a share of their length: obtuse.
inline mesh::Model slender_panel(double aspect, double shear) {
  const int columns = static_cast<int>(70 / std::sqrt(aspect)), rows = static_cast<int>(70 * std::sqrt(aspect));
  const double wide = 100.0 / columns, high = 100.0 / rows;
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double x = wide * (i + 0.2 * noise(i, j, 1) + shear * (j % 2)), y = high * (j + 0.2 * noise(i, j, 2));
      nodes.push_back({1 + i + (columns + 1) * j, on_panel(x, y)});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::int64_t a = 1 + i + (columns + 1) * j, b = a + 1, d = a + columns + 1, c = d + 1;
      const auto id = static_cast<std::int64_t>(shells.size()) + 1;
      shells.push_back({id, 1, {a, b, c}});
      shells.push_back({id + 1, 1, {a, c, d}});
    }
  return make_model(nodes, shells);
}

/// Three curved sheets of 57 x 57 quads that meet along a line.
inline mesh::Model three_sheets(double jitter) {
  constexpr int kSide = 57;
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  const auto id = [](int sheet, int i, int j) { return i == 0 ? 1 + j : 100000 * (sheet + 1) + i + 100 * j; };
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j <= kSide; ++j)
      for (int i = sheet == 0 ? 0 : 1; i <= kSide; ++i) {
        const double u = i + (i == 0 ? 0 : jitter * noise(i, j, 10 + sheet)), v = j + jitter * noise(i, j, i == 0 ? 20 : 20 + sheet);
        const double angle = 2.0943951 * sheet, out = 4 * std::sin(u / 14) * std::cos(v / 17);
        nodes.push_back({id(sheet, i, j), {u * std::cos(angle) - out * std::sin(angle), u * std::sin(angle) + out * std::cos(angle), v}});
      }
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1,
                          sheet + 1,
                          {id(sheet, i, j), id(sheet, i + 1, j), id(sheet, i + 1, j + 1), id(sheet, i, j + 1)}});
  return make_model(nodes, shells);
}

/// 5 x 5 cells of 20 x 20, each a round hole of radius 5 in rings of quads, on the panel.
inline mesh::Model holed_panel() {
  constexpr int kAround = 40, kRings = 9;
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  std::map<std::pair<long, long>, std::int64_t> known;
  const auto node_at = [&](double x, double y) {
    const auto [at, is_new] = known.try_emplace({std::lround(1e6 * x), std::lround(1e6 * y)}, static_cast<std::int64_t>(nodes.size()) + 1);
    if (is_new) nodes.push_back({at->second, on_panel(x, y)});
    return at->second;
  };
  const auto place = [](int k, int ring) {
    const double angle = 2 * 3.14159265358979 * k / kAround, c = std::cos(angle), s = std::sin(angle);
    // the cell's outline in ten even steps a side, from the middle of its right side
    const int side = ((k + 5) % kAround) / 10, step = (k + 5) % 10;
    const double along = -10 + 2.0 * step;
    const std::array<std::array<double, 2>, 4> outline{{{10, along}, {-along, 10}, {-10, -along}, {along, -10}}};
    const double share = static_cast<double>(ring) / kRings;
    const auto& out = outline[static_cast<std::size_t>(side)];
    return std::array{(1 - share) * 5 * c + share * out[0], (1 - share) * 5 * s + share * out[1]};
  };
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      const auto corner = [&](int k, int ring) {
        const auto [x, y] = place(k % kAround, ring);
        return node_at(20 * column + 10 + x, 20 * row + 10 + y);
      };
      for (int ring = 0; ring < kRings; ++ring)
        for (int k = 0; k < kAround; ++k)
          shells.push_back({static_cast<std::int64_t>(shells.size()) + 1,
                            1,
                            {corner(k, ring), corner(k, ring + 1), corner(k + 1, ring + 1), corner(k + 1, ring)}});
    }
  return make_model(nodes, shells);
}

}  // namespace prismesh::test
