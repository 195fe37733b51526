// Histograms of quality metrics: every measured shell is in one bin, and a few extreme shells don't spoil the range.
#include "mesh/report/histogram.h"

#include <numeric>

#include <gtest/gtest.h>

#include "mesh/report/html.h"

namespace prismesh::mesh::report {
namespace {

/// Rectangles of width 1 with these heights, each with nodes of its own.
document::Generation strip(const std::vector<double>& heights) {
  document::Generation generation;
  std::vector<Vec3> positions;
  std::vector<ShellNodes> shells;
  for (std::size_t shell = 0; shell < heights.size(); ++shell) {
    const double x = 2.0 * static_cast<double>(shell);
    const auto first = static_cast<std::uint32_t>(4 * shell);
    for (const Vec3& corner : {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x + 1, heights[shell], 0), Vec3(x, heights[shell], 0)})
      positions.push_back(corner);
    ShellNodes corners;
    for (std::uint32_t corner = 0; corner < 4; ++corner) corners.node[corner] = NodeIndex(first + corner);
    shells.push_back(corners);
  }
  generation.model.positions.resize(positions.size(), Vec3::Zero());
  for (std::size_t node = 0; node < positions.size(); ++node) generation.model.positions.set(node, positions[node]);
  generation.model.shell_nodes.resize(shells.size());
  for (std::size_t shell = 0; shell < shells.size(); ++shell) generation.model.shell_nodes.set(shell, shells[shell]);
  generation.quality.resize(shells.size());
  return generation;
}

const Histogram* of(const std::vector<Histogram>& all, quality::Metric metric) {
  for (const Histogram& each : all)
    if (each.metric == metric) return &each;
  return nullptr;
}

std::size_t sum(const std::vector<std::size_t>& bins) { return std::accumulate(bins.begin(), bins.end(), std::size_t{0}); }

TEST(HistogramTest, every_shell_is_in_the_bin_of_its_value) {
  const std::vector<Histogram> all = histograms(strip({1, 2, 2, 4}), strip({1, 1, 4}));
  const Histogram* aspect = of(all, quality::Metric::aspect);
  ASSERT_NE(aspect, nullptr);
  EXPECT_DOUBLE_EQ(aspect->low, 1);
  EXPECT_DOUBLE_EQ(aspect->high, 4);
  EXPECT_EQ(sum(aspect->before), 4U);
  EXPECT_EQ(sum(aspect->after), 3U);
  EXPECT_EQ(aspect->before.front(), 1U);
  EXPECT_EQ(aspect->before[kHistogramBins / 3], 2U) << "2 lies a third of the way from 1 to 4";
  EXPECT_EQ(aspect->before.back(), 1U);
  EXPECT_EQ(aspect->after.front(), 2U);
  EXPECT_FALSE(aspect->more_below || aspect->more_above);
  EXPECT_EQ(of(all, quality::Metric::min_angle_tri), nullptr) << "there are no triangles";
}

TEST(HistogramTest, an_extreme_shell_is_counted_at_the_end_and_told) {
  std::vector<double> heights;
  for (int i = 0; i < 1000; ++i) heights.push_back(1 + 0.001 * i);
  heights.push_back(5000);
  const std::vector<Histogram> all = histograms(strip(heights), strip({1}));
  const Histogram* aspect = of(all, quality::Metric::aspect);
  ASSERT_NE(aspect, nullptr);
  EXPECT_LT(aspect->high, 10);
  EXPECT_TRUE(aspect->more_above);
  EXPECT_FALSE(aspect->more_below);
  EXPECT_EQ(aspect->before.back(), 1U);
  EXPECT_EQ(sum(aspect->before), 1001U);
}

TEST(HistogramTest, equal_values_and_removed_or_degenerate_shells) {
  document::Generation before = strip({1, 1, 1, 1});
  before.quality.set(1, quality::ShellState::removed());
  before.quality.set(2, {quality::ShellState::kDefectBits, quality::ShellState::kDefectBits});
  const std::vector<Histogram> all = histograms(before, strip({}));
  const Histogram* aspect = of(all, quality::Metric::aspect);
  ASSERT_NE(aspect, nullptr);
  EXPECT_LT(aspect->low, 1);
  EXPECT_GT(aspect->high, 1);
  EXPECT_EQ(sum(aspect->before), 2U);
  EXPECT_TRUE(histograms(strip({}), strip({})).empty());
}

TEST(HtmlTest, text_is_escaped) {
  EXPECT_EQ(html_text("<a href=\"x\">'&'\x01"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;\\x01");
  EXPECT_EQ(html_text("d\xc3\xbcnn \xff"), "d\xc3\xbcnn \\xFF");
}

}  // namespace
}  // namespace prismesh::mesh::report
