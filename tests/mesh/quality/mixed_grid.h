// Quads and triangles of all sorts, for tests that compare ways of measuring.
#pragma once

#include <random>

#include "tests/support/make_model.h"

namespace prismesh::test {

/// A square grid of unit quads, every third cut in two, its nodes moved at random by up to `farthest`; evenly, or (`growing`) from nothing
/// at one side to all of it at the other: from good shells to crossed ones.
inline mesh::Model mixed_grid(int side, double farthest, bool growing, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> away(-farthest, farthest);
  std::vector<mesh::Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) {
      const double share = growing ? static_cast<double>(i) / side : 1.0;
      points.emplace_back(i + share * away(random), j + share * away(random), share * away(random));
    }
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const int a = j * (side + 1) + i, b = a + side + 1;
      if ((i + j) % 3 != 0) {
        shells.push_back({a, a + 1, b + 1, b});
        continue;
      }
      shells.push_back({a, a + 1, b + 1, b + 1});
      shells.push_back({a, b + 1, b, b});
    }
  return make_shells(points, shells);
}

}  // namespace prismesh::test
