#include "kiosk/tools/selection/outline.h"

#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::kiosk::tools::selection {
namespace {

using input::Pixel;

double area_of(const std::vector<Pixel>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Pixel &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

TEST(Outline, what_lies_beyond_the_line_is_cut_off) {
  const std::vector<Pixel> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  EXPECT_EQ(kept_right_of(square, -1), square);
  EXPECT_TRUE(kept_right_of(square, 10.5).empty());
  EXPECT_DOUBLE_EQ(area_of(kept_right_of(square, 4)), 60);
  const std::vector<Pixel> triangle{{0, 0}, {10, 0}, {0, 10}};
  EXPECT_DOUBLE_EQ(area_of(kept_right_of(triangle, 5)), 12.5) << "half as wide, half as high";
  // Two prongs that reach over the line from the left stay two, though joined along it.
  const std::vector<Pixel> fork{{0, 0}, {10, 0}, {10, 2}, {4, 2}, {4, 8}, {10, 8}, {10, 10}, {0, 10}};
  EXPECT_DOUBLE_EQ(area_of(kept_right_of(fork, 6)), 2 * 4 * 2);
  for (const Pixel& each : kept_right_of(fork, 6)) EXPECT_GE(each.x(), 6);
  EXPECT_TRUE(kept_right_of({}, 0).empty());
}

}  // namespace
}  // namespace prismesh::kiosk::tools::selection
