// Small models made by hand, for tests: nodes and elements by the ids that a deck would give them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::test {

struct NodeSpec {
  std::int64_t id = 0;
  mesh::Vec3 position = mesh::Vec3::Zero();
};

/// Three node ids make a triangle.
struct ShellSpec {
  std::int64_t id = 0;
  std::int64_t part = 1;
  std::vector<std::int64_t> nodes;
};

/// An element of any class but shell.
struct ElementSpec {
  mesh::ElementClass element_class = mesh::ElementClass::beam;
  std::int64_t id = 0;
  std::int64_t part = 1;
  std::vector<std::int64_t> nodes;
};

/// A complete model: id indices, adjacency, and a defined part for each part id in use (and each of `empty_parts`).
/// Throws std::invalid_argument where an element names a node that isn't there.
inline mesh::Model make_model(const std::vector<NodeSpec>& nodes, const std::vector<ShellSpec>& shells,
                              const std::vector<ElementSpec>& elements = {}, const std::vector<std::int64_t>& empty_parts = {}) {
  using namespace prismesh::mesh;
  Model model;
  std::vector<std::int64_t> node_ids;
  std::vector<std::int64_t> shell_ids;
  std::vector<std::int64_t> part_ids = empty_parts;
  for (const NodeSpec& node : nodes) node_ids.push_back(node.id);
  for (const ShellSpec& shell : shells) shell_ids.push_back(shell.id), part_ids.push_back(shell.part);
  for (const ElementSpec& element : elements) part_ids.push_back(element.part);
  std::sort(part_ids.begin(), part_ids.end());
  part_ids.erase(std::unique(part_ids.begin(), part_ids.end()), part_ids.end());
  model.node_index = std::make_shared<IdIndex>(node_ids);
  model.shell_index = std::make_shared<IdIndex>(shell_ids);

  const auto node_of = [&](std::int64_t id) {
    const NodeIndex node = model.find_node(id);
    if (!node.valid()) throw std::invalid_argument("make_model: an element names a node that isn't there");
    return node;
  };
  const auto part_of = [&](std::int64_t id) {
    return PartIndex(static_cast<std::size_t>(std::lower_bound(part_ids.begin(), part_ids.end(), id) - part_ids.begin()));
  };

  model.node_ids.resize(nodes.size());
  model.positions.resize(nodes.size(), Vec3::Zero());
  model.node_holds.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    model.node_ids.set(i, nodes[i].id);
    model.positions.set(i, nodes[i].position);
  }
  model.shell_ids.resize(shells.size());
  model.shell_nodes.resize(shells.size());
  model.shell_parts.resize(shells.size());
  model.shell_thickness.resize(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    ShellNodes corners;
    for (std::size_t c = 0; c < 4; ++c) corners.node[c] = node_of(shells[i].nodes[std::min(c, shells[i].nodes.size() - 1)]);
    model.shell_ids.set(i, shells[i].id);
    model.shell_nodes.set(i, corners);
    model.shell_parts.set(i, part_of(shells[i].part));
  }

  std::array<ElementBlock, kElementClassCount> blocks;
  for (const ElementSpec& element : elements) {
    ElementBlock& block = blocks[static_cast<std::size_t>(element.element_class)];
    block.id.push_back(element.id);
    block.part.push_back(part_of(element.part));
    for (const std::int64_t id : element.nodes) block.nodes.push_back(node_of(id));
    block.first_node.push_back(static_cast<std::uint32_t>(block.nodes.size()));
  }
  for (std::size_t c = 1; c < blocks.size(); ++c) model.elements[c] = std::make_shared<ElementBlock>(std::move(blocks[c]));

  std::vector<Part> parts;
  for (const std::int64_t id : part_ids) {
    Part part;
    part.id = id;
    part.name = "part " + std::to_string(id);
    part.defined = true;
    parts.push_back(part);
  }
  model.parts = std::make_shared<std::vector<Part>>(std::move(parts));
  model.midside = std::make_shared<std::vector<MidsideNodes>>();
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  return model;
}

/// A model of points and shells that name them by position, from 0; ids are positions + 1. A triangle repeats its third.
inline mesh::Model make_shells(const std::vector<mesh::Vec3>& points, const std::vector<std::array<int, 4>>& corners) {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (const mesh::Vec3& point : points) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, point});
  for (const std::array<int, 4>& c : corners)
    shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, 1, {c[0] + 1, c[1] + 1, c[2] + 1, c[3] + 1}});
  return make_model(nodes, shells);
}

/// A grid of columns × rows quads, its node (i, j) at place(i, j). Node ids are 1 + i + j·(columns+1), shell ids
/// 1 + i + j·columns, all in part 1. `keep(i, j)` false leaves a shell out; its nodes stay.
inline mesh::Model make_grid(int columns, int rows, const std::function<mesh::Vec3(int i, int j)>& place,
                             const std::function<bool(int i, int j)>& keep = {}) {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  const std::int64_t stride = columns + 1;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) nodes.push_back({1 + i + j * stride, place(i, j)});
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::int64_t corner = 1 + i + j * stride;
      if (!keep || keep(i, j))
        shells.push_back({1 + i + std::int64_t{j} * columns, 1, {corner, corner + 1, corner + 1 + stride, corner + stride}});
    }
  return make_model(nodes, shells);
}

/// Index of node (i, j) of make_grid.
inline mesh::NodeIndex grid_node(int columns, int i, int j) { return mesh::NodeIndex(static_cast<std::size_t>(i + j * (columns + 1))); }

/// The same model with all parts of this thickness.
inline mesh::Model with_thickness(mesh::Model model, double thickness) {
  std::vector<mesh::Part> parts = *model.parts;
  for (mesh::Part& part : parts) part.thickness = thickness;
  model.parts = std::make_shared<const std::vector<mesh::Part>>(std::move(parts));
  return model;
}

}  // namespace prismesh::test
