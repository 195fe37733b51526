// Models on which trees of boxes and bricks are tried, and the same answers without a tree, in double precision.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/point_triangle.h"
#include "tests/mesh/spatial/trial_sheets.h"

namespace prismesh::test {

/// Calls `visit(a, b, c)` for each finite triangle of a shell, as docs/distance-field.md defines them.
template <class Visit>
void each_trial_triangle(const mesh::Model& model, mesh::ShellIndex shell, Visit&& visit) {
  if (model.is_removed(shell)) return;
  const mesh::ShellNodes& nodes = model.shell(shell);
  const auto at = [&](std::size_t c) { return model.position(nodes.node[c]); };
  const auto add = [&](std::size_t b, std::size_t c) {
    if (at(0).allFinite() && at(b).allFinite() && at(c).allFinite()) visit(at(0), at(b), at(c));
  };
  add(1, 2);
  if (!nodes.is_triangle()) add(2, 3);
}

/// The square of the distance from a shell; infinite without a finite triangle.
inline double plain_distance2(const mesh::Model& model, mesh::ShellIndex shell, const mesh::Vec3& point) {
  double best = std::numeric_limits<double>::infinity();
  each_trial_triangle(model, shell, [&](const mesh::Vec3& a, const mesh::Vec3& b, const mesh::Vec3& c) {
    best = std::min(best, mesh::spatial::closest_on_triangle({a, b, c}, point).distance2);
  });
  return best;
}

struct PlainNearest {
  mesh::ShellIndex shell;
  double distance = std::numeric_limits<double>::infinity();
};
inline PlainNearest plain_nearest(const mesh::Model& model, const mesh::Vec3& point) {
  PlainNearest nearest;
  double min2 = nearest.distance;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const double d2 = plain_distance2(model, mesh::ShellIndex(s), point); d2 < min2) {
      min2 = d2;
      nearest = {mesh::ShellIndex(s), std::sqrt(d2)};
    }
  return nearest;
}

/// A sheet folded back on itself twice, with layers 0.3 apart.
inline mesh::Model folded_sheet() {
  return make_grid(36, 14, [](int i, int j) {
    const int fold = i / 12, along = i % 12;
    const double x = fold % 2 == 0 ? along : 12 - along;
    return mesh::Vec3(x + 0.2 * noise(i, j, 1), j + 0.2 * noise(i, j, 2), 0.3 * fold + 0.05 * noise(i, j, 3));
  });
}

/// Three sheets that meet along a line: small.
inline mesh::Model junction() {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  const auto id = [](int sheet, int i, int j) { return i == 0 ? 1 + j : 1000 * (sheet + 1) + i + 20 * j; };
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j <= 9; ++j)
      for (int i = sheet == 0 ? 0 : 1; i <= 9; ++i) {
        const double angle = 2.0943951 * sheet;
        nodes.push_back({id(sheet, i, j), {i * std::cos(angle), i * std::sin(angle), j + 0.2 * noise(i, j, sheet)}});
      }
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i)
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1,
                          1,
                          {id(sheet, i, j), id(sheet, i + 1, j), id(sheet, i + 1, j + 1), id(sheet, i, j + 1)}});
  return make_model(nodes, shells);
}

/// A sheet with shells that have no area, needles, corners that aren't finite, and a corner far away.
inline mesh::Model spoiled_sheet() {
  mesh::Model model = make_grid(20, 20, [](int i, int j) { return mesh::Vec3(i, j, 0.3 * noise(i, j, 1)); });
  const auto set = [&](int i, int j, const mesh::Vec3& to) { model.positions.set(grid_node(20, i, j).value, to); };
  const double inf = std::numeric_limits<double>::infinity();
  set(3, 3, {std::nan(""), 0, 0});
  set(8, 3, {8, inf, 0});
  set(15, 4, {-inf, inf, std::nan("")});
  set(11, 11, model.position(grid_node(20, 12, 11)));  // no area
  set(12, 12, model.position(grid_node(20, 12, 11)));
  set(5, 15, model.position(grid_node(20, 6, 15)) + mesh::Vec3(1e-11, 0, 1e-12));
  set(0, 20, {1e7, 0, 0});
  return model;
}

inline mesh::Model with_adjacency(mesh::Model model) {
  model.adjacency = std::make_shared<const mesh::Adjacency>(mesh::build_adjacency(model));
  return model;
}

/// Moves nodes, splits quads into triangles, removes and adds shells; the model is ready for the next edit.
inline mesh::Model edited_at_random(mesh::Model model, std::mt19937& random) {
  using namespace prismesh::mesh;
  std::uniform_real_distribution<double> shift(-0.4, 0.4);
  const auto any = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
  std::int64_t next_id = 1'000'000 + static_cast<std::int64_t>(model.shell_count() + model.node_count());
  for (int i = 0; i < 25; ++i) {
    const std::size_t node = any(model.node_count());
    model.positions.set(node, Vec3(model.positions[node] + Vec3(shift(random), shift(random), shift(random))));
  }
  for (int i = 0; i < 12; ++i) {
    const ShellIndex shell(any(model.shell_count()));
    if (model.is_removed(shell)) continue;
    const ShellNodes nodes = model.shell(shell);
    const auto [a, b, c, d] = nodes.node;
    switch (i % 4) {
      case 0: remove_shell(model, shell); break;
      case 1:
        if (nodes.is_triangle()) break;
        set_shell_nodes(model, shell, {{a, b, c, c}});
        add_shell(model, next_id++, {{a, c, d, d}}, shell);
        break;
      case 2: {
        const NodeIndex middle = add_node(model, next_id++, (model.position(a) + model.position(c)) / 2, centre_origin(nodes));
        set_shell_nodes(model, shell, {{a, b, middle, middle}});
        add_shell(model, next_id++, {{b, c, middle, middle}}, shell);
        if (nodes.is_triangle()) add_shell(model, next_id++, {{c, a, middle, middle}}, shell);
        if (!nodes.is_triangle()) add_shell(model, next_id++, {{c, d, a, middle}}, shell);
        break;
      }
      default: add_shell(model, next_id++, {{d, c, b, a}}, shell); break;
    }
  }
  return with_adjacency(std::move(model));
}

}  // namespace prismesh::test
