// Sheets of shells to plant defects in, and what a repair's result makes of a model.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/model/topology_change.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/repair.h"

namespace prismesh::mesh::repair {

inline NodeIndex at(std::size_t node) { return NodeIndex(node); }
inline ShellIndex shell_at(std::size_t shell) { return ShellIndex(shell); }

/// Nodes have ids from 1, shells from 101, all in part 0.
inline Model model_of(const std::vector<Vec3>& positions, const std::vector<std::array<std::size_t, 4>>& shells) {
  Model model;
  std::vector<std::int64_t> node_ids, shell_ids;
  for (std::size_t i = 0; i < positions.size(); ++i) node_ids.push_back(static_cast<std::int64_t>(i) + 1);
  for (std::size_t i = 0; i < shells.size(); ++i) shell_ids.push_back(static_cast<std::int64_t>(i) + 101);
  model.positions.resize(positions.size(), Vec3::Zero());
  model.node_ids.resize(positions.size());
  model.node_holds.resize(positions.size());
  model.shell_ids.resize(shells.size());
  model.shell_nodes.resize(shells.size());
  model.shell_parts.resize(shells.size(), PartIndex(std::size_t{0}));
  model.shell_thickness.resize(shells.size(), 1.0F);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    model.positions.set(i, positions[i]);
    model.node_ids.set(i, node_ids[i]);
  }
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const auto& s = shells[i];
    model.shell_ids.set(i, shell_ids[i]);
    model.shell_nodes.set(i, {{at(s[0]), at(s[1]), at(s[2]), at(s[3])}});
  }
  model.midside = std::make_shared<const std::vector<MidsideNodes>>();
  model.node_index = std::make_shared<const IdIndex>(node_ids);
  model.shell_index = std::make_shared<const IdIndex>(shell_ids);
  Part part;
  part.id = 1;
  part.thickness = 1.0;
  model.parts = std::make_shared<const std::vector<Part>>(2, part);
  std::vector<bool> has_shell(positions.size(), false);
  for (const auto& shell : shells)
    for (const std::size_t node : shell) has_shell[node] = true;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!has_shell[i]) remove_node(model, at(i));  // inside a hole
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

/// A grid of quads; node (i, j) is i + j * (columns + 1), shell (i, j) is i + j * columns; `holes` leaves shells out.
struct Grid {
  std::size_t columns = 12, rows = 12;
  std::function<Vec3(double, double)> place = [](double x, double y) { return Vec3(x, y, 0); };
  std::function<bool(std::size_t, std::size_t)> is_hole;

  std::size_t node(std::size_t i, std::size_t j) const { return i + j * (columns + 1); }
  std::vector<Vec3> positions() const {
    std::vector<Vec3> all;
    for (std::size_t j = 0; j <= rows; ++j)
      for (std::size_t i = 0; i <= columns; ++i) all.push_back(place(static_cast<double>(i), static_cast<double>(j)));
    return all;
  }
  std::vector<std::array<std::size_t, 4>> shells() const {
    std::vector<std::array<std::size_t, 4>> all;
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < columns; ++i)
        if (!is_hole || !is_hole(i, j)) all.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    return all;
  }
  /// Number of the shell with corner (i, j), counting the holes out.
  std::size_t shell(std::size_t i, std::size_t j) const {
    const auto all = shells();
    for (std::size_t s = 0; s < all.size(); ++s)
      if (all[s][0] == node(i, j)) return s;
    return all.size();
  }
};

inline Grid flat(std::size_t columns = 12, std::size_t rows = 12) {
  return {columns, rows, [](double x, double y) { return Vec3(x, y, 0); }, {}};
}
/// A quarter of a tube of radius 12 about the y axis.
inline Grid cylinder() {
  return {18, 12, [](double x, double y) { return Vec3(12 * std::sin(x / 12), y, 12 * std::cos(x / 12)); }, {}};
}
/// Two flanges at right angles with a square hole in each.
inline Grid l_profile() {
  return {16, 14, [](double x, double y) { return x <= 8 ? Vec3(x, y, 0) : Vec3(8, y, x - 8); },
          [](std::size_t i, std::size_t j) { return (i == 3 || i == 4 || i == 11 || i == 12) && j >= 5 && j <= 7; }};
}

/// What a restructuring makes of a model, with adjacency; ids go on from the last.
inline Model carried_out(const Model& model, const Restructuring& change) {
  Model next = model;
  auto node_id = static_cast<std::int64_t>(100000), shell_id = static_cast<std::int64_t>(200000);
  for (const NewNode& node : change.new_nodes) add_node(next, node_id++, node.position, node.origin);
  for (const NewShell& shell : change.new_shells) add_shell(next, shell_id++, shell.nodes, shell.parent);
  for (const auto& [shell, nodes] : change.reshaped) set_shell_nodes(next, shell, nodes);
  for (const ShellIndex shell : change.removed_shells) remove_shell(next, shell);
  for (const NodeIndex node : change.removed_nodes) remove_node(next, node);
  for (const auto& [node, position] : change.moved) next.positions.set(node.value, position);
  next.adjacency = std::make_shared<const Adjacency>(build_adjacency(next));
  return next;
}

inline ShellSet all_shells(const Model& model) {
  ShellSet all;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (!model.is_removed(ShellIndex(s))) all.push_back(ShellIndex(s));
  return all;
}

}  // namespace prismesh::mesh::repair
