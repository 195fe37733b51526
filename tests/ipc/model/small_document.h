// A document made by hand: a flat grid of quads in one part, one beam, one solid, without any deck.
#pragma once

#include <memory>

#include "mesh/document/document.h"
#include "mesh/document/generation.h"

namespace prismesh::ipc::test {

inline mesh::document::Document grid_document(std::size_t columns, std::size_t rows) {
  using namespace mesh;
  document::Generation generation;
  Model& model = generation.model;
  const std::size_t nodes = (columns + 1) * (rows + 1);
  model.node_ids.resize(nodes);
  model.positions.resize(nodes, Vec3::Zero());
  model.node_holds.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    model.node_ids.set(n, static_cast<std::int64_t>(n + 1));
    model.positions.set(n, Vec3(static_cast<double>(n % (columns + 1)), static_cast<double>(n / (columns + 1)), 0));
  }
  model.shell_ids.resize(columns * rows);
  model.shell_nodes.resize(columns * rows);
  model.shell_parts.resize(columns * rows);
  model.shell_thickness.resize(columns * rows);
  for (std::size_t s = 0; s < columns * rows; ++s) {
    const std::size_t corner = s / columns * (columns + 1) + s % columns;
    model.shell_ids.set(s, static_cast<std::int64_t>(s + 1));
    model.shell_nodes.set(
        s, ShellNodes{{NodeIndex(corner), NodeIndex(corner + 1), NodeIndex(corner + columns + 2), NodeIndex(corner + columns + 1)}});
    model.shell_parts.set(s, PartIndex(0));
  }
  Part part;
  part.id = 7;
  part.name = "panel";
  model.parts = std::make_shared<const std::vector<Part>>(1, part);
  for (auto& block : model.elements) block = std::make_shared<const ElementBlock>();
  generation.node_marks.resize(nodes);
  generation.shell_marks.resize(columns * rows);
  generation.quality.resize(columns * rows);
  generation.parts = std::make_shared<const std::vector<document::PartState>>(1);
  generation.number = 1;
  generation.made_by = "open";
  document::Document made;
  made.path = "grid.k";
  made.generations.push_back(std::make_shared<const document::Generation>(std::move(generation)));
  made.opened = made.generations.front();
  made.next_number = 2;
  return made;
}

/// The next generation with one node moved.
inline void move_node(mesh::document::Document& document, std::size_t node, const mesh::Vec3& to) {
  auto next = std::make_shared<mesh::document::Generation>(document.current());
  next->model.positions.set(node, to);
  next->number = document.next_number++;
  next->made_by = "translate";
  document.generations.push_back(std::move(next));
  document.cursor = document.generations.size() - 1;
}

}  // namespace prismesh::ipc::test
