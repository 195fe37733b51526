// The feature lines that are remembered are those of the model.
#include "mesh/relax/line_cache.h"

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "tests/mesh/spatial/trial_sheets.h"

namespace prismesh::mesh::relax {
namespace {

/// A sheet of two parts whose nodes are off its plane by up to `roughness` of an element: the rougher, the more of its edges are creases.
Model rough_sheet(double roughness) {
  Model model = test::make_grid(14, 12, [&](int i, int j) { return Vec3(i, j, roughness * test::noise(i, j, 3)); });
  for (std::size_t s = 0; s < model.shell_count(); s += 3) model.shell_parts.set(s, PartIndex(std::size_t{7}));
  return model;
}

TEST(LineCache, knows_the_feature_edges_of_every_shell) {
  const double cos_limit = deterministic_cos_degrees(30);
  std::size_t features = 0, others = 0, crowded = 0;
  for (const double roughness : {0.0, 0.2, 0.5, 2.0}) {
    const Model model = rough_sheet(roughness);
    const LineCache lines(model, cos_limit);
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      for (std::size_t i = 0; i < 4; ++i) {
        const NodeIndex a = model.shell(ShellIndex(s)).node[i], b = model.shell(ShellIndex(s)).node[(i + 1) % 4];
        const ShellIndex beyond = smooth_neighbour(model, ShellIndex(s), a, b, cos_limit);
        const bool is_feature = !beyond.valid() || model.shell_parts[beyond.value] != model.shell_parts[s];
        EXPECT_EQ(lines.is_feature(ShellIndex(s), a, b), is_feature) << roughness << ": " << a.value << "-" << b.value;
        (is_feature ? features : others) += 1;
        crowded += lines.at(a).ends.count == LineEnds::kMax && lines.at(b).ends.count == LineEnds::kMax ? 1 : 0;
      }
  }
  EXPECT_GT(features, 100U);
  EXPECT_GT(others, 100U);
  EXPECT_GT(crowded, 100U);  // where it has to look at the shells
}

TEST(LineCache, gives_the_same_lines_to_several_threads) {
  const double cos_limit = deterministic_cos_degrees(30);
  const Model model = rough_sheet(0.3);
  const LineCache lines(model, cos_limit);
  parallel_for(4 * model.node_count(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) lines.at(NodeIndex(i % model.node_count()));
  });
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const LineEnds ends = line_ends(model, NodeIndex(n), cos_limit, true);
    const NodeLines& known = lines.at(NodeIndex(n));
    EXPECT_EQ(&known, &lines.at(NodeIndex(n)));
    ASSERT_EQ(known.ends.count, ends.count);
    EXPECT_EQ(known.ends.other, ends.other);
    EXPECT_EQ(known.pass_through, passes_through(model, NodeIndex(n), ends, cos_limit));
  }
}

}  // namespace
}  // namespace prismesh::mesh::relax
