#include "mesh/model/features.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh {
namespace {

using test::make_shells;
using Corners = std::array<int, 4>;

/// Two quads that share the edge 1-2 and are bent by an angle about it.
Model bent(double degrees, const Corners& second) {
  const double angle = degrees * 3.14159265358979 / 180;
  const double x = 1 + std::cos(angle), z = std::sin(angle);
  return make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {x, 0, z}, {x, 1, z}}, {Corners{0, 1, 2, 3}, second});
}
constexpr Corners kSameSense = {1, 4, 5, 2};
constexpr Corners kOtherSense = {2, 5, 4, 1};

EdgeKind kind_of_middle(const Model& model, double limit) {
  const EdgeIndex edge = model.adjacency->find_edge(NodeIndex(std::size_t{1}), NodeIndex(std::size_t{2}));
  return classify_edge(model, edge, model.adjacency->edge(edge), limit);
}

TEST(Features, a_crease_is_sharper_than_the_limit_whatever_the_normals_say) {
  for (const Corners& second : {kSameSense, kOtherSense}) {
    EXPECT_EQ(kind_of_middle(bent(0, second), 30), EdgeKind::smooth);
    EXPECT_EQ(kind_of_middle(bent(29, second), 30), EdgeKind::smooth);
    EXPECT_EQ(kind_of_middle(bent(31, second), 30), EdgeKind::crease);
    EXPECT_EQ(kind_of_middle(bent(-31, second), 30), EdgeKind::crease);
    EXPECT_EQ(kind_of_middle(bent(90, second), 60), EdgeKind::crease);
    // folded almost onto itself: the normals are as parallel as on a flat sheet, the sheet isn't
    EXPECT_EQ(kind_of_middle(bent(175, second), 30), EdgeKind::crease);
    EXPECT_EQ(kind_of_middle(bent(119, second), 120), EdgeKind::smooth);
    EXPECT_EQ(kind_of_middle(bent(121, second), 120), EdgeKind::crease);
  }
}

TEST(Features, slanted_flat_neighbours_are_smooth) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {2, 1, 0}, {9, -4, 0}}, {Corners{0, 1, 2, 3}, Corners{1, 4, 2, 2}});
  EXPECT_EQ(kind_of_middle(model, 1), EdgeKind::smooth);
}

TEST(Features, ends_and_junctions) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}, {1, 0, 1}, {1, 1, 1}},
                                  {Corners{0, 1, 2, 3}, Corners{1, 4, 5, 2}, Corners{1, 6, 7, 2}});
  EXPECT_EQ(kind_of_middle(model, 30), EdgeKind::junction);
  std::size_t free = 0, junction = 0;
  for (const EdgeKind kind : classify_edges(model, 30)) {
    free += kind == EdgeKind::free;
    junction += kind == EdgeKind::junction;
  }
  EXPECT_EQ(free, 9u);
  EXPECT_EQ(junction, 1u);
}

TEST(Features, a_shell_without_width_makes_no_crease) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0.5, 0}}, {Corners{0, 1, 2, 3}, Corners{1, 4, 2, 2}});
  EXPECT_EQ(kind_of_middle(model, 30), EdgeKind::smooth);
}

TEST(Features, all_edges_as_one_by_one) {
  const Model model =
      test::make_grid(40, 30, [](int i, int j) { return Vec3(i, j, (i % 7 == 0 ? 0.8 : 0) + (j > 15 ? (j - 15) * 2 : 0)); });
  const auto kinds = classify_edges(model, 30);
  ASSERT_EQ(kinds.size(), model.adjacency->edge_count());
  for (std::size_t e = 0; e < kinds.size(); ++e)
    EXPECT_EQ(kinds[e], classify_edge(model, EdgeIndex(e), model.adjacency->edge(EdgeIndex(e)), 30));
}

}  // namespace
}  // namespace prismesh::mesh
