// Fillets of several rows bound a region as a whole; sheets that bend alike everywhere have none.
#include "mesh/select/fillets.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/region.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using test::make_grid;

constexpr int kColumns = 4;  ///< of quads along each row

/// A sheet made of rows of quads; row r is turned by the sum of the first r angles about y.
Model sheet_of_rows(const std::vector<double>& bends, const std::vector<double>& widths) {
  std::vector<Vec3> line{Vec3::Zero()};
  double turned = 0;
  for (std::size_t r = 0; r < widths.size(); ++r) {
    turned += bends[r];
    line.push_back(line.back() + widths[r] * Vec3(deterministic_cos_degrees(turned), 0, deterministic_sin_degrees(turned)));
  }
  return make_grid(static_cast<int>(widths.size()), kColumns,
                   [&](int i, int j) { return Vec3(line[static_cast<std::size_t>(i)] + Vec3(0, j, 0)); });
}

/// A flat, a fillet of `rows` rows that bends by `total`, and a flat behind it.
Model filleted(int rows, double total, int flat = 6, double width = 0.4) {
  std::vector<double> bends(static_cast<std::size_t>(flat), 0.0), widths(static_cast<std::size_t>(flat), 1.0);
  // tangent to the flats: the first and the last edge bend by half
  for (int r = 0; r < rows; ++r) {
    bends.push_back(r == 0 ? total / rows / 2 : total / rows);
    widths.push_back(width);
  }
  bends.push_back(total / rows / 2);
  widths.push_back(1);
  bends.insert(bends.end(), static_cast<std::size_t>(flat - 1), 0.0);
  widths.insert(widths.end(), static_cast<std::size_t>(flat - 1), 1.0);
  return sheet_of_rows(bends, widths);
}

/// The number of rows that a region over the whole width has.
std::size_t rows_found(const Model& model, std::size_t row, double angle, RegionBound bound = RegionBound::features) {
  // make_grid numbers shells row by row in its second direction
  const std::size_t rows = model.shell_count() / kColumns;
  const ShellSet found = region(model, {ShellIndex(row + rows)}, {bound, angle, {}, nullptr});
  EXPECT_EQ(found.size() % kColumns, 0u);
  return found.size() / kColumns;
}

TEST(Fillets, of_any_number_of_rows_bound_a_region_whatever_the_angle) {
  for (const int rows : {2, 3, 4, 6, 8})
    for (const double angle : {20.0, 30.0, 40.0, 60.0}) {
      const Model model = filleted(rows, 90);
      EXPECT_EQ(rows_found(model, 1, angle), 6u) << rows << " rows, " << angle;
      EXPECT_EQ(rows_found(model, 6, angle), static_cast<std::size_t>(rows)) << rows << " rows, " << angle;
      EXPECT_EQ(rows_found(model, model.shell_count() / kColumns - 2, angle), 6u) << rows << " rows, " << angle;
    }
}

TEST(Fillets, count_edge_by_edge_only_where_asked) {
  const Model model = filleted(4, 90);
  EXPECT_EQ(rows_found(model, 1, 30, RegionBound::creases), 16u);
  EXPECT_EQ(rows_found(model, 1, 15, RegionBound::creases), 7u);  // up to the edge of 22.5 degrees behind that of 11.25
}

TEST(Fillets, bend_by_more_than_the_angle) {
  const Model model = filleted(4, 35);
  EXPECT_EQ(rows_found(model, 1, 40), 16u);
  EXPECT_EQ(rows_found(model, 1, 30), 6u);
}

TEST(Fillets, may_lie_at_the_end_of_the_sheet) {
  // a rolled edge: flat, then three rows up to the free edge
  const Model model = sheet_of_rows({0, 0, 0, 0, 0, 25, 25, 25}, {1, 1, 1, 1, 1, 0.4, 0.4, 0.4});
  EXPECT_EQ(rows_found(model, 1, 30), 5u);
}

TEST(Fillets, may_bend_back_at_once_on_one_side) {
  // a joggle: two fillets that touch
  const Model model =
      sheet_of_rows({0, 0, 0, 0, 0, 20, 20, 20, -20, -20, -20, 0, 0, 0, 0}, {1, 1, 1, 1, 1, 0.4, 0.4, 0.4, 0.4, 0.4, 1, 1, 1, 1, 1});
  EXPECT_EQ(rows_found(model, 1, 30), 5u);
  EXPECT_EQ(rows_found(model, 13, 30), 5u);
}

TEST(Fillets, are_none_where_a_sheet_bends_alike_everywhere) {
  // half a tube, in 10 degrees a row, and in 30
  EXPECT_EQ(rows_found(sheet_of_rows(std::vector<double>(18, 10), std::vector<double>(18, 1)), 5, 20), 18u);
  EXPECT_EQ(rows_found(sheet_of_rows(std::vector<double>(6, 30), std::vector<double>(6, 1)), 3, 40), 6u);
  // a corrugated sheet
  std::vector<double> wave;
  for (int i = 0; i < 32; ++i) wave.push_back(15 * deterministic_sin_degrees(22.5 * i));
  EXPECT_EQ(rows_found(sheet_of_rows(wave, std::vector<double>(32, 1)), 5, 30), 32u);
}

TEST(Fillets, are_the_same_whichever_way_shells_are_turned) {
  Model model = filleted(4, 90);
  for (std::size_t s = 0; s < model.shell_count(); s += 3) {
    ShellNodes nodes = model.shell_nodes[s];
    std::swap(nodes.node[1], nodes.node[3]);
    model.shell_nodes.set(s, nodes);
  }
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  EXPECT_EQ(rows_found(model, 1, 30), 6u);
  EXPECT_EQ(rows_found(model, 7, 30), 4u);
}

TEST(Fillets, a_crease_whose_angle_varies_bounds_a_region_as_a_whole) {
  // a plate folded along x = 4 by 50 degrees, but only by 20 within three of its twelve columns
  const auto folded = [](double middle) {
    return make_grid(8, 12, [&](int i, int j) {
      const double fold = j >= 5 && j <= 7 ? middle : 50;
      const double beyond = std::max(i - 4, 0);
      return Vec3(std::min(i, 4) + beyond * deterministic_cos_degrees(fold), j, beyond * deterministic_sin_degrees(fold));
    });
  };
  const auto from_corner = [](const Model& model) {
    return region(model, {ShellIndex(0)}, {RegionBound::features, 30, {}, nullptr}).size();
  };
  EXPECT_EQ(from_corner(folded(20)), 48u);
  EXPECT_EQ(from_corner(folded(2)), 96u);  // there the fold has an end: the region goes round
}

}  // namespace
}  // namespace prismesh::mesh::select
