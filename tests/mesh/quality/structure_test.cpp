#include "mesh/quality/structure.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

ShellIndex shell(std::size_t i) { return ShellIndex(i); }

Model curved_grid(int columns, int rows, const std::function<bool(int, int)>& keep = {}) {
  return test::make_grid(
      columns, rows, [](int i, int j) { return Vec3(i, j, 0.01 * i * i); }, keep);
}

/// Points of a row of quads, one unit each; node 2i below, 2i + 1 above.
std::vector<Vec3> strip(int quads) {
  std::vector<Vec3> points;
  for (int i = 0; i <= quads; ++i) points.insert(points.end(), {Vec3(i, 0, 0), Vec3(i, 1, 0)});
  return points;
}

TEST(Structure, of_a_sound_sheet_is_clean) {
  const Structure found = check_structure(curved_grid(8, 6));
  EXPECT_TRUE(found.duplicates.empty());
  EXPECT_TRUE(found.opposed.empty());
  EXPECT_TRUE(found.multiple.empty());
  EXPECT_TRUE(found.unjoined.empty());
  EXPECT_TRUE(found.free_inside.empty());
  EXPECT_TRUE(found.clusters.empty());
  EXPECT_EQ(found.max_triangles, 0u);
}

TEST(Structure, duplicates_have_the_same_corners_in_whatever_order) {
  const Model model = test::make_shells(strip(3), {{0, 2, 3, 1}, {2, 4, 5, 3}, {3, 1, 0, 2}, {4, 6, 7, 7}, {7, 4, 6, 6}, {1, 3, 2, 0}});
  EXPECT_EQ(check_structure(model).duplicates, (ShellSet{shell(2), shell(4), shell(5)}));
  const ShellSet only = {shell(2), shell(3)};
  EXPECT_EQ(check_structure(model, {}, &only).duplicates, ShellSet{shell(2)});
}

TEST(Structure, normals_that_disagree_show_at_the_shared_edge) {
  const Model model = test::make_shells(strip(3), {{0, 2, 3, 1}, {2, 3, 5, 4}, {4, 6, 7, 5}});
  const Structure found = check_structure(model);
  ASSERT_EQ(found.opposed.size(), 2u);
  const Adjacency& adjacency = *model.adjacency;
  EXPECT_EQ(found.opposed[0], adjacency.find_edge(NodeIndex(std::size_t{2}), NodeIndex(std::size_t{3})));
  EXPECT_EQ(found.opposed[1], adjacency.find_edge(NodeIndex(std::size_t{4}), NodeIndex(std::size_t{5})));
}

TEST(Structure, three_sheets_at_an_edge_are_multiple_and_not_opposed) {
  std::vector<Vec3> points = strip(2);
  points.insert(points.end(), {Vec3(1, 0, 1), Vec3(1, 1, 1)});
  const Model model = test::make_shells(points, {{0, 2, 3, 1}, {2, 4, 5, 3}, {2, 6, 7, 3}});
  const Structure found = check_structure(model);
  ASSERT_EQ(found.multiple.size(), 1u);
  EXPECT_EQ(found.multiple[0], model.adjacency->find_edge(NodeIndex(std::size_t{2}), NodeIndex(std::size_t{3})));
  EXPECT_TRUE(found.opposed.empty());
}

TEST(Structure, edges_at_one_place_that_are_not_joined) {
  // the second quad has its own nodes, 1/1000 beside the first one's
  std::vector<Vec3> points = strip(1);
  points.insert(points.end(), {Vec3(1.001, 0, 0), Vec3(1, 1.001, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)});
  const Model model = test::make_shells(points, {{0, 2, 3, 1}, {4, 6, 7, 5}});
  EXPECT_EQ(check_structure(model).unjoined.size(), 2u);
  StructureOptions narrow;
  narrow.tolerance = 0.0005;
  EXPECT_TRUE(check_structure(model, narrow).unjoined.empty());
  // two parts may well lie edge to edge
  Model parts = model;
  parts.parts = std::make_shared<std::vector<Part>>(2);
  parts.shell_parts.set(1, PartIndex(std::size_t{1}));
  EXPECT_TRUE(check_structure(parts).unjoined.empty());
}

TEST(Structure, a_node_that_hangs_on_an_edge_is_not_joined) {
  // quads of half the size beside a whole one
  const std::vector<Vec3> points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}, {3, 2, 0}};
  const Model model = test::make_shells(points, {{0, 1, 2, 3}, {1, 5, 6, 4}, {4, 6, 7, 2}});
  EXPECT_EQ(check_structure(model).unjoined.size(), 3u);  // the long edge and both halves
}

TEST(Structure, a_missing_shell_leaves_free_edges_inside) {
  const Model model = curved_grid(6, 6, [](int i, int j) { return i != 2 || j != 3; });
  const Structure found = check_structure(model);
  EXPECT_EQ(found.free_inside.size(), 4u);
  EXPECT_TRUE(found.unjoined.empty());
  // a hole of several shells is a hole, and so is the border of a piece of one or two shells
  EXPECT_TRUE(check_structure(curved_grid(6, 6, [](int i, int j) { return i < 2 || i > 3 || j != 3; })).free_inside.empty());
  EXPECT_TRUE(check_structure(test::make_shells(strip(1), {{0, 2, 3, 1}})).free_inside.empty());
  EXPECT_TRUE(check_structure(test::make_shells(strip(1), {{0, 2, 3, 3}, {0, 3, 1, 1}})).free_inside.empty());
}

TEST(Structure, the_border_of_a_small_piece_with_a_node_inside_is_no_hole) {
  for (const double up : {0.0, 0.3}) {  // flat, and a low pyramid
    const std::vector<Vec3> four = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}, {2, 0.5, up}};
    EXPECT_TRUE(check_structure(test::make_shells(four, {{0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}})).free_inside.empty());
    const std::vector<Vec3> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, up}};
    EXPECT_TRUE(check_structure(test::make_shells(three, {{0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}})).free_inside.empty());
  }
  // a ring of quads about a triangle that is missing, its inner border as long as those
  const std::vector<Vec3> ring = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-2, -1, 0}, {4, -1, 0}, {-2, 4, 0}};
  EXPECT_EQ(check_structure(test::make_shells(ring, {{0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}})).free_inside.size(), 3u);
}

TEST(Structure, edges_at_one_place_are_found_whatever_the_length_of_others) {
  for (const double size : {1e-3, 0.499, 0.5, 0.501, 1.0, 300.0}) {
    std::vector<Vec3> points = {{0, 0, 0}, {1e9, 0, 0}, {0, 1e9, 0}};
    const auto quad = [&](double x, double height) {
      const double y = 10;
      points.insert(points.end(), {Vec3(x, y, 0), Vec3(x + size, y, 0), Vec3(x + size, y + height, 0), Vec3(x, y + height, 0)});
    };
    quad(10, size);
    quad(10 + size, 1.004 * size);
    const Model model = test::make_shells(points, {{0, 1, 2, 2}, {3, 4, 5, 6}, {7, 8, 9, 10}});
    EXPECT_EQ(check_structure(model).unjoined.size(), 2u) << size;
  }
}

TEST(Structure, a_long_edge_of_one_part_is_not_joined_by_shells_of_another) {
  const std::vector<Vec3> points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}, {3, 2, 0}};
  Model model = test::make_shells(points, {{0, 1, 2, 3}, {1, 5, 6, 4}, {4, 6, 7, 2}});
  model.parts = std::make_shared<std::vector<Part>>(2);
  model.shell_parts.set(2, PartIndex(std::size_t{1}));
  EXPECT_TRUE(check_structure(model).unjoined.empty());
}

TEST(Structure, a_hole_between_two_parts_is_inside_none) {
  Model model = curved_grid(5, 5, [](int i, int j) { return i != 2 || j != 2; });
  EXPECT_EQ(check_structure(model).free_inside.size(), 4u);
  model.parts = std::make_shared<std::vector<Part>>(2);
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (model.position(model.shell(shell(s)).node[0]).x() < 2) model.shell_parts.set(s, PartIndex(std::size_t{1}));
  EXPECT_TRUE(check_structure(model).free_inside.empty());
}

TEST(Structure, shells_that_run_along_an_edge_twice_are_not_opposed_there) {
  const Model model = test::make_shells(strip(2), {{0, 2, 0, 1}, {0, 2, 0, 3}});
  EXPECT_TRUE(check_structure(model).opposed.empty());
}

/// Six triangles about node 0 in two rings of six quads: a third of the shells are triangles.
Model fan_in_quads() {
  std::vector<Vec3> points = {{0, 0, 0}};
  std::vector<std::array<int, 4>> shells;
  for (int ring = 1; ring <= 3; ++ring)
    for (int i = 0; i < 6; ++i) points.emplace_back(ring * std::cos(i * 1.0471975511965976), ring * std::sin(i * 1.0471975511965976), 0);
  for (int i = 0; i < 6; ++i) shells.push_back({0, 1 + i, 1 + (i + 1) % 6, 1 + (i + 1) % 6});
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 6; ++i)
      shells.push_back({1 + 6 * ring + i, 7 + 6 * ring + i, 7 + 6 * ring + (i + 1) % 6, 1 + 6 * ring + (i + 1) % 6});
  return test::make_shells(points, shells);
}

TEST(Structure, triangles_about_a_node) {
  const Model model = fan_in_quads();
  const Structure found = check_structure(model);
  EXPECT_EQ(found.max_triangles, 6u);
  EXPECT_EQ(found.max_triangles_at, NodeIndex(std::size_t{0}));
  EXPECT_EQ(found.clusters, NodeSet{NodeIndex(std::size_t{0})});
  StructureOptions strict;
  strict.triangles_at_node = 1;
  const ShellSet three = {shell(0), shell(1), shell(2)};
  EXPECT_EQ(check_structure(model, {}, &three).max_triangles, 3u) << "others don't count";
  EXPECT_EQ(check_structure(model, strict).clusters.size(), 7u);
}

TEST(Structure, of_a_mesh_of_triangles_counts_them_and_finds_no_cluster) {
  const Model model = test::make_shells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                        {{0, 1, 2, 2}, {0, 2, 3, 3}, {0, 3, 4, 4}, {0, 4, 1, 1}});
  EXPECT_EQ(check_structure(model).max_triangles, 4u);
  EXPECT_TRUE(check_structure(model).clusters.empty());
}

TEST(Structure, as_many_triangles_as_are_allowed_are_no_cluster) {
  const Model model = fan_in_quads();
  StructureOptions options;
  options.triangles_at_node = 6;
  EXPECT_TRUE(check_structure(model, options).clusters.empty());
  options.triangles_at_node = 5;
  EXPECT_EQ(check_structure(model, options).clusters, NodeSet{NodeIndex(0)});
}

TEST(Structure, of_some_shells_is_what_lies_at_them) {
  const auto in = [](const Model& model, std::size_t only) {
    const ShellSet scope{shell(only)};
    return check_structure(model, {}, &scope);
  };
  const Model turned = test::make_shells(strip(3), {{0, 2, 3, 1}, {2, 3, 5, 4}, {4, 6, 7, 5}});
  EXPECT_EQ(in(turned, 0).opposed.size(), 1u);
  EXPECT_EQ(in(turned, 1).opposed.size(), 2u);
  std::vector<Vec3> points = strip(3);
  points.insert(points.end(), {Vec3(1, 0, 1), Vec3(1, 1, 1)});
  const Model branched = test::make_shells(points, {{0, 2, 3, 1}, {2, 4, 5, 3}, {4, 6, 7, 5}, {2, 8, 9, 3}});
  EXPECT_EQ(in(branched, 2).multiple.size(), 0u);
  EXPECT_EQ(in(branched, 3).multiple.size(), 1u);
  points = strip(1);
  points.insert(points.end(), {Vec3(1.001, 0, 0), Vec3(1, 1.001, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)});
  const Model apart = test::make_shells(points, {{0, 2, 3, 1}, {4, 6, 7, 5}});
  EXPECT_EQ(in(apart, 1).unjoined, std::vector<EdgeIndex>{apart.adjacency->find_edge(NodeIndex(4), NodeIndex(5))});
  const Model holed = curved_grid(6, 6, [](int i, int j) { return i != 2 || j != 3; });
  EXPECT_EQ(in(holed, 1 + 6 * 3).free_inside.size(), 1u) << "to the left of the hole";
  EXPECT_EQ(in(holed, 0).free_inside.size(), 0u);
}

TEST(Structure, removed_and_degenerate_shells_do_no_harm) {
  Model model = curved_grid(4, 4);
  set_shell_nodes(
      model, shell(5),
      {{model.shell(shell(5)).node[0], model.shell(shell(5)).node[0], model.shell(shell(5)).node[2], model.shell(shell(5)).node[2]}});
  remove_shell(model, shell(0));
  remove_shell(model, shell(10));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  model.positions.set(20, Vec3(nan, nan, nan));
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  const Structure found = check_structure(model);
  EXPECT_TRUE(found.duplicates.empty());
  EXPECT_EQ(found.free_inside.size(), 4u + 4u + 1u);  // about shells 10 and 5, and across the latter
}

}  // namespace
}  // namespace prismesh::mesh::quality
