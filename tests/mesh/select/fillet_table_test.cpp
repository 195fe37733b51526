// Regions beside fillets on generated sheets: rows, beads that end near the fillet, angles, shares of triangles.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/region.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

constexpr int kFlat = 12, kBeyond = 8, kAcross = 24;  ///< quads of 5 mm
constexpr double kSize = 5;

struct Sheet {
  int rows = 4;       ///< of the fillet
  double bead = 4;    ///< between the end of the bead and the fillet; below 0: no bead
  double angle = 90;  ///< of the fillet
  int triangles = 0;  ///< percent of quads that are two triangles

  std::string label() const {
    return std::to_string(rows) + " rows, bead at " + std::to_string(static_cast<int>(bead)) + ", " +
           std::to_string(static_cast<int>(angle)) + " degrees, " + std::to_string(triangles) + " % triangles";
  }
};

/// The profile in x and z: a flat, an arc with rows of about 4 mm, a flat.
std::vector<Vec3> profile(const Sheet& sheet) {
  std::vector<Vec3> line;
  for (int i = 0; i <= kFlat; ++i) line.emplace_back(kSize * i, 0, 0);
  const double radius = sheet.rows * 4.0 * 57.29577951308232 / sheet.angle;
  for (int r = 1; r <= sheet.rows; ++r) {
    const double turned = sheet.angle * r / sheet.rows;
    line.emplace_back(kSize * kFlat + radius * deterministic_sin_degrees(turned), 0, -radius * (1 - deterministic_cos_degrees(turned)));
  }
  const Vec3 end = line.back(), along(deterministic_cos_degrees(sheet.angle), 0, -deterministic_sin_degrees(sheet.angle));
  for (int i = 1; i <= kBeyond; ++i) line.push_back(end + kSize * i * along);
  return line;
}

/// The bead's height at x on its middle line: 4, falling to 0 over 12 mm before its end.
double bead_height(const Sheet& sheet, double x) {
  if (sheet.bead < 0) return 0;
  const double before_end = kSize * kFlat - sheet.bead - x;
  return before_end <= 0 ? 0 : 4 * std::min(1.0, before_end / 12);
}

Model made(const Sheet& sheet) {
  const std::vector<Vec3> line = profile(sheet);
  const int columns = static_cast<int>(line.size()) - 1;
  std::vector<test::NodeSpec> nodes;
  const auto id = [&](int i, int j) { return 1 + i + std::int64_t{j} * (columns + 1); };
  for (int j = 0; j <= kAcross; ++j)
    for (int i = 0; i <= columns; ++i) {
      Vec3 at = line[static_cast<std::size_t>(i)] + Vec3(0, kSize * j, 0);
      if (j == kAcross / 2 && i <= kFlat) at[2] += bead_height(sheet, at[0]);
      nodes.push_back({id(i, j), at});
    }
  std::vector<test::ShellSpec> shells;
  std::int64_t next = 1;
  std::uint32_t random = 12345;
  for (int j = 0; j < kAcross; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::int64_t a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
      random = random * 1664525U + 1013904223U;
      if (static_cast<int>((random >> 16) % 100) >= sheet.triangles) {
        shells.push_back({next++, 1, {a, b, c, d}});
      } else if ((random >> 8 & 1) != 0) {
        shells.push_back({next++, 1, {a, b, c, c}});
        shells.push_back({next++, 1, {a, c, d, d}});
      } else {
        shells.push_back({next++, 1, {a, b, d, d}});
        shells.push_back({next++, 1, {b, c, d, d}});
      }
    }
  return test::make_model(nodes, shells, {});
}

/// The columns of nodes of the region at a shell near a point, and whether it is whole: all nodes of these columns.
struct Columns {
  int first = 0, last = 0;
  bool whole = false;
};

Columns region_columns(const Model& model, const Sheet& sheet, const Vec3& point) {
  const ShellSet shells = region(model, shells_near(model, point, {}), {RegionBound::features, 30, {}, nullptr});
  const NodeSet nodes = nodes_of(model, shells);
  const int columns = kFlat + sheet.rows + kBeyond + 1;
  Columns found{columns, -1, false};
  for (const NodeIndex node : nodes) {
    const int column = static_cast<int>(node.value) % columns;
    found.first = std::min(found.first, column);
    found.last = std::max(found.last, column);
  }
  found.whole = nodes.size() == static_cast<std::size_t>((found.last - found.first + 1) * (kAcross + 1));
  return found;
}

void expect_regions(const Sheet& sheet) {
  SCOPED_TRACE(sheet.label());
  const Model model = made(sheet);
  const std::vector<Vec3> line = profile(sheet);
  const auto between = [&](int column) {
    return Vec3(0.5 * (line[static_cast<std::size_t>(column)] + line[static_cast<std::size_t>(column) + 1]) + Vec3(0, 0.4 * kSize, 0));
  };
  struct Expected {
    int at, first, last;
  };
  const int end = kFlat + sheet.rows;
  for (const Expected& expected : {Expected{1, 0, kFlat}, {kFlat + sheet.rows / 2, kFlat, end}, {end + kBeyond - 2, end, end + kBeyond}}) {
    const Columns found = region_columns(model, sheet, between(expected.at));
    EXPECT_EQ(found.first, expected.first) << "from column " << expected.at;
    EXPECT_EQ(found.last, expected.last) << "from column " << expected.at;
    EXPECT_TRUE(found.whole) << "from column " << expected.at;
  }
}

TEST(FilletTable, a_bead_that_ends_near_the_fillet_opens_no_gap) {
  for (const int rows : {1, 2, 3, 4, 6, 8})
    for (const double bead : {-1.0, 0.0, 4.0, 12.0, 20.0}) expect_regions({rows, bead, 90, 0});
}

TEST(FilletTable, nor_do_other_angles) {
  for (const int rows : {2, 4, 8})
    for (const double angle : {45.0, 60.0, 120.0})
      for (const double bead : {0.0, 4.0}) expect_regions({rows, bead, angle, 0});
}

TEST(FilletTable, nor_do_triangles) {
  for (const int rows : {2, 4, 8})
    for (const int triangles : {10, 50, 100})
      for (const double bead : {-1.0, 4.0}) expect_regions({rows, bead, 90, triangles});
}

}  // namespace
}  // namespace prismesh::mesh::select
