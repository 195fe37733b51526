#include "mesh/model/element_lines.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace prismesh::mesh {

namespace {

struct Line {
  NodeIndex low;
  NodeIndex high;
  PartIndex part;
};

/// A face by its corners in ascending order (a triangle's fourth is invalid), and the element it belongs to.
struct Face {
  std::array<NodeIndex, 4> sorted;
  std::uint32_t element = 0;
  std::uint8_t number = 0;
};

using Corners = std::array<NodeIndex, 4>;

/// A face's corners without repeated neighbours; the rest are invalid.
Corners without_repeats(const Corners& corners) {
  Corners kept;
  std::size_t count = 0;
  for (const NodeIndex node : corners)
    if (node.valid() && std::find(kept.begin(), kept.begin() + count, node) == kept.begin() + count) kept[count++] = node;
  return kept;
}

std::size_t corner_count(const Corners& corners) {
  return static_cast<std::size_t>(std::count_if(corners.begin(), corners.end(), [](NodeIndex node) { return node.valid(); }));
}

std::span<const NodeIndex> nodes_of(const ElementBlock& block, std::size_t element) {
  return std::span(block.nodes).subspan(block.first_node[element], block.first_node[element + 1] - block.first_node[element]);
}

/// The faces of a solid in a deck's node order. A brick with repeated nodes is a wedge or a pyramid (its flattened faces
/// have fewer than three corners left); with four distinct nodes it is a tetrahedron. Mid-side nodes come last and don't
/// count: 10 nodes are a tetrahedron, 15 a wedge, 20 a brick.
std::vector<Corners> faces_of(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> distinct;
  for (const NodeIndex node : nodes)
    if (std::find(distinct.begin(), distinct.end(), node) == distinct.end()) distinct.push_back(node);
  const NodeIndex none;
  const auto tetrahedron = [&](const std::vector<NodeIndex>& n) {
    return std::vector<Corners>{{n[0], n[1], n[2], none}, {n[0], n[1], n[3], none}, {n[1], n[2], n[3], none}, {n[0], n[2], n[3], none}};
  };
  if (distinct.size() == 4 || distinct.size() == 10) return tetrahedron(distinct);
  if (nodes.size() == 6 || nodes.size() == 15)
    return {{nodes[0], nodes[1], nodes[2], none},
            {nodes[3], nodes[4], nodes[5], none},
            {nodes[0], nodes[1], nodes[4], nodes[3]},
            {nodes[1], nodes[2], nodes[5], nodes[4]},
            {nodes[2], nodes[0], nodes[3], nodes[5]}};
  if (nodes.size() < 8) return {};
  const auto& n = nodes;
  return {{n[0], n[1], n[2], n[3]}, {n[4], n[5], n[6], n[7]}, {n[0], n[1], n[5], n[4]},
          {n[1], n[2], n[6], n[5]}, {n[2], n[3], n[7], n[6]}, {n[3], n[0], n[4], n[7]}};
}

void add_line(NodeIndex a, NodeIndex b, PartIndex part, std::vector<Line>& lines) {
  if (a.valid() && b.valid() && a != b) lines.push_back({std::min(a, b), std::max(a, b), part});
}

void add_bars(const ElementBlock* block, std::vector<Line>& lines) {
  if (block == nullptr) return;
  // A beam's third node only gives its orientation.
  for (std::size_t e = 0; e < block->size(); ++e)
    if (const auto nodes = nodes_of(*block, e); nodes.size() >= 2) add_line(nodes[0], nodes[1], block->part[e], lines);
}

void add_outer_edges(const ElementBlock* block, std::vector<Line>& lines) {
  if (block == nullptr) return;
  std::vector<Face> faces;
  faces.reserve(block->size() * 6);
  for (std::size_t e = 0; e < block->size(); ++e) {
    const std::vector<Corners> corners = faces_of(nodes_of(*block, e));
    for (std::size_t f = 0; f < corners.size(); ++f) {
      Face face{without_repeats(corners[f]), static_cast<std::uint32_t>(e), static_cast<std::uint8_t>(f)};
      if (corner_count(face.sorted) < 3) continue;
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.sorted != b.sorted ? a.sorted < b.sorted : a.element < b.element; });
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t next = i + 1;
    while (next < faces.size() && faces[next].sorted == faces[i].sorted) ++next;
    if (next == i + 1) {
      const Face& face = faces[i];
      const Corners corners = without_repeats(faces_of(nodes_of(*block, face.element))[face.number]);
      const std::size_t count = corner_count(corners);
      for (std::size_t k = 0; k < count; ++k) add_line(corners[k], corners[(k + 1) % count], block->part[face.element], lines);
    }
    i = next;
  }
}

}  // namespace

ElementLines element_lines(const Model& model) {
  const auto block = [&](ElementClass kind) { return model.elements[static_cast<std::size_t>(kind)].get(); };
  std::vector<Line> lines;
  add_outer_edges(block(ElementClass::solid), lines);
  add_outer_edges(block(ElementClass::tshell), lines);
  add_bars(block(ElementClass::beam), lines);
  add_bars(block(ElementClass::discrete), lines);
  const auto key = [](const Line& line) { return std::array{line.low.value, line.high.value, line.part.value}; };
  std::sort(lines.begin(), lines.end(), [&](const Line& a, const Line& b) { return key(a) < key(b); });
  lines.erase(std::unique(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.low == b.low && a.high == b.high; }),
              lines.end());

  ElementLines result{ChunkedArray<NodeIndex>(2 * lines.size()), ChunkedArray<PartIndex>(lines.size())};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    result.nodes.set(2 * i, lines[i].low);
    result.nodes.set(2 * i + 1, lines[i].high);
    result.parts.set(i, lines[i].part);
  }
  return result;
}

}  // namespace prismesh::mesh
