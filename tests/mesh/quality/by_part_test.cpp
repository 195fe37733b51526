// Target sizes and criteria by part: each shell is judged by those of its part, wherever shells are judged.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/quality/composite.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/report.h"
#include "mesh/quality/target_size.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

/// Separate plates of columns x rows quads, one for each size, parts 1, 2, ..; `jitter` is a fraction of the size.
Model plates(const std::vector<double>& sizes, int columns, int rows, double jitter = 0) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-jitter, jitter);
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    const auto first = static_cast<std::int64_t>(100000 * (p + 1));
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        nodes.push_back({first + j * (columns + 1) + i, Vec3((i + off(random)) * sizes[p], (j + off(random)) * sizes[p],
                                                             1000.0 * static_cast<double>(p) + off(random) * sizes[p])});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const std::int64_t corner = first + j * (columns + 1) + i;
        const bool triangle = (i + j) % 5 == 0;
        shells.push_back({first + j * columns + i, static_cast<std::int64_t>(p + 1),
                          triangle ? std::vector<std::int64_t>{corner, corner + 1, corner + columns + 2}
                                   : std::vector<std::int64_t>{corner, corner + 1, corner + columns + 2, corner + columns + 1}});
      }
  }
  // Shells of all parts take turns, so that every batch holds shells of several.
  std::stable_sort(shells.begin(), shells.end(), [](const auto& a, const auto& b) { return a.id % 100000 < b.id % 100000; });
  return test::make_model(nodes, shells, {});
}

std::vector<Vec3> corners_of_shell(const Model& model, std::size_t shell) {
  std::vector<Vec3> corners;
  const ShellNodes& nodes = model.shell_nodes[shell];
  for (int c = 0; c < nodes.corners(); ++c) corners.push_back(model.position(nodes.node[static_cast<std::size_t>(c)]));
  return corners;
}

/// What a shell's part is judged by, found without the code under test.
struct Own {
  const Criteria* criteria;
  double size;
};

TEST(ByPart, each_part_is_judged_by_its_own_edges) {
  const Model model = plates({5, 130}, 8, 6);
  const double deck = guess_target_size(model);
  EXPECT_GT(count(judge_model(model, {default_criteria(), deck})).fail, 0u) << "one size for all";
  const CriteriaByPart by_part = share_entries(guess_part_sizes(model, deck));
  EXPECT_EQ(by_part.of(PartIndex(0)).target_size, 5);
  EXPECT_EQ(by_part.of(PartIndex(1)).target_size, 130);
  const Report all = report(model, {default_criteria(), deck, &by_part}, {});
  for (const Metric length : {Metric::min_length, Metric::max_length}) {
    EXPECT_EQ(all.metrics[static_cast<std::size_t>(length)].warn, 0u);
    EXPECT_EQ(all.metrics[static_cast<std::size_t>(length)].fail, 0u);
  }
}

TEST(ByPart, a_shell_has_the_state_and_composite_that_it_has_alone) {
  Model model = plates({1, 5, 5, 40}, 12, 10, 0.3);
  for (std::size_t s = 0; s < model.shell_count(); ++s) model.shell_thickness.set(s, s % 2 == 0 ? 0.0F : 9.0F);
  const auto strict = std::make_shared<const Criteria>(load_criteria("strict").value());
  const auto thin = std::make_shared<const Criteria>(
      parse_criteria("name = \"thin\"\n[metrics.min_length]\nfail_below_thicknesses = 0.5\nfail_below = 0.1\n", "thin.toml").value());
  const CriteriaByPart by_part = share_entries(
      {{1, nullptr, SizeFrom::part}, {4, strict, SizeFrom::given}, {5, thin, SizeFrom::given}, {60, nullptr, SizeFrom::given}});
  EXPECT_EQ(by_part.distinct.size(), 4u);
  const SizedCriteria sized{default_criteria(), 2, &by_part};
  const Own own[] = {{&default_criteria(), 1}, {strict.get(), 4}, {thin.get(), 5}, {&default_criteria(), 60}};

  const ChunkedArray<ShellState> states = judge_model(model, sized);
  std::vector<ShellIndex> all;
  for (std::size_t s = 0; s < model.shell_count(); ++s) all.emplace_back(s);
  std::vector<float> rated(all.size());
  composites(model, all, sized, rated);
  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 4>> corners;
  std::vector<ShellProperties> properties;
  Counts expected;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const Own& its = own[model.shell_parts[s].value];
    const std::vector<Vec3> at = corners_of_shell(model, s);
    const Values values = measure(at);
    EXPECT_EQ(states[s], judge(values, {*its.criteria, its.size}, ShellProperties(thickness_of(model, s)))) << s;
    EXPECT_EQ(rated[s], composite(values, {*its.criteria, its.size}, ShellProperties(thickness_of(model, s)))) << s;
    EXPECT_EQ(states[s], judge(values, sized, properties_of(model, ShellIndex(s))));
    const auto first = static_cast<std::int32_t>(points.size());
    points.insert(points.end(), at.begin(), at.end());
    corners.push_back({first, first + 1, first + 2, first + static_cast<std::int32_t>(at.size()) - 1});
    properties.push_back(properties_of(model, ShellIndex(s)));
    const Grade grade = states[s].grade();
    ++(grade == Grade::ok ? expected.ok : grade == Grade::warn ? expected.warn : expected.fail);
  }
  EXPECT_GT(expected.ok, 0u);
  EXPECT_GT(expected.fail, 0u);
  EXPECT_EQ(count(states), expected);
  EXPECT_EQ(report(model, sized, {}).counts, expected);

  std::vector<ShellState> by_points(corners.size());
  std::vector<float> rated_by_points(corners.size());
  judge_points({points, {}, corners, properties}, sized, by_points, rated_by_points);
  for (std::size_t s = 0; s < corners.size(); ++s) EXPECT_EQ(by_points[s], states[s]);
  EXPECT_EQ(rated_by_points, rated);

  ChunkedArray<ShellState> again = judge_model(model, {default_criteria(), 2});
  Counts counts = count(again);
  rejudge(model, sized, all, again, counts);
  EXPECT_EQ(counts, expected);
}

TEST(ByPart, one_entry_for_all_parts_judges_as_one_size_does) {
  const Model model = plates({1, 5}, 12, 10, 0.3);
  const CriteriaByPart by_part = share_entries({{3, nullptr, SizeFrom::given}, {3, nullptr, SizeFrom::given}});
  EXPECT_EQ(by_part.distinct.size(), 1u);
  const auto one = judge_model(model, {default_criteria(), 3}), parts = judge_model(model, {default_criteria(), 99, &by_part});
  for (std::size_t s = 0; s < one.size(); ++s) EXPECT_EQ(one[s], parts[s]);
}

TEST(ByPart, limits_of_a_length_are_those_of_the_part) {
  const CriteriaByPart by_part = share_entries({{5, nullptr, SizeFrom::part}, {50, nullptr, SizeFrom::part}});
  const SizedCriteria sized{default_criteria(), 20, &by_part};
  const auto max_length = [&](PartIndex part) {
    ShellProperties properties;
    properties.part = part;
    return threshold_of(sized, Metric::max_length, false, properties).fail_high;
  };
  EXPECT_EQ(max_length(PartIndex(0)), 10);
  EXPECT_EQ(max_length(PartIndex(1)), 100);
  EXPECT_EQ(max_length(PartIndex()), 40) << "of shells that belong to no part";
}

TEST(PartSizes, a_part_with_few_edges_takes_the_decks_size) {
  // A plate of 2 x 2 has 12 edges and two diagonals; one of 3 x 3 has 24.
  const Model small = plates({5, 5, 20}, 2, 2);
  const std::vector<PartCriteria> sizes = guess_part_sizes(small, 5);
  EXPECT_EQ(sizes[2].target_size, 5);
  EXPECT_EQ(sizes[2].size_from, SizeFrom::deck);
  const std::vector<PartCriteria> enough = guess_part_sizes(plates({5, 5, 20}, 3, 3), 5);
  EXPECT_EQ(enough[2].target_size, 20);
  EXPECT_EQ(enough[2].size_from, SizeFrom::part);
}

TEST(PartSizes, of_elongated_shells_lie_between_their_two_lengths) {
  const auto plate = [](double x, double y) { return test::make_grid(8, 8, [=](int i, int j) { return Vec3(x * i, y * j, 0); }); };
  EXPECT_EQ(guess_part_sizes(plate(4, 16), 1)[0].target_size, 8) << "neither 4 nor 16: by 4 each shell would fail";
  EXPECT_EQ(guess_part_sizes(plate(16, 4), 1)[0].target_size, 8);
  const double close = guess_part_sizes(plate(5, 8), 1)[0].target_size;
  EXPECT_TRUE(close == 5 || close == 8) << close << ": the median, where both lengths are fine";
}

TEST(PartSizes, are_rounded_to_two_digits_and_skip_edges_without_a_length) {
  Model model = plates({5.234, 0.00098765}, 6, 6);
  EXPECT_DOUBLE_EQ(guess_part_sizes(model, 1)[0].target_size, 5.2);
  EXPECT_DOUBLE_EQ(guess_part_sizes(model, 1)[1].target_size, 0.00099);
  model.positions.set(0, Vec3(std::nan(""), 0, 0));
  EXPECT_DOUBLE_EQ(guess_part_sizes(model, 1)[0].target_size, 5.2);
  EXPECT_TRUE(guess_part_sizes(test::make_shells({}, {}), 1).empty() || guess_part_sizes(test::make_shells({}, {}), 1)[0].target_size == 1);
}

}  // namespace
}  // namespace prismesh::mesh::quality
