// Quads as cells of a sheet, two triangles that make a quad counting as one, and walks over rows of them. Private to mesh/select.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::select {

inline constexpr std::size_t kMaxRows = 8;  ///< of a fillet

/// A quad, or two triangles that together are one: nodes in a cycle, and the shells.
struct Cell {
  std::array<NodeIndex, 4> node;
  ShellIndex one, other;  ///< the same for a quad

  Edge edge(std::size_t position) const {
    const NodeIndex a = node[position], b = node[(position + 1) % 4];
    return a < b ? Edge{a, b} : Edge{b, a};
  }
  /// The position of the edge; 4 if it has no such edge.
  std::size_t position_of(Edge wanted) const {
    for (std::size_t i = 0; i < 4; ++i)
      if (const Edge here = edge(i); here.low == wanted.low && here.high == wanted.high) return i;
    return 4;
  }
};

/// What one walk across opposite edges of cells found: the edges in order and how it ended.
struct Walk {
  struct Crossing {
    double degrees = 0;  ///< positive: towards the side of the normal at the start
    double curvature = 0;
  };
  std::array<Crossing, kMaxRows + 3> edges;
  std::size_t count = 0;
  bool at_end = false;  ///< the sheet ends behind the last edge: a free edge, a junction or a triangle that is no half of a quad
};

/// Pairs of triangles are found when they are first asked for.
class Cells {
 public:
  /// Keeps references; `model` needs its adjacency.
  Cells(const Model& model, OutOfSight out_of_sight);

  /// Nothing for a triangle that is no half of a quad.
  std::optional<Cell> of(ShellIndex shell);
  /// The one other visible shell at an edge; invalid at a free edge or junction.
  ShellIndex only_neighbour(ShellIndex shell, Edge edge) const;
  /// The same beyond a cell's edge.
  ShellIndex beyond(const Cell& cell, std::size_t position) const;
  /// Whether the sheet bends at a cell's edge by a small angle at most, or ends there. Cheaper than a walk. The answer is
  /// remembered for the edge, so `radians` must always be the same.
  bool is_flat_at(const Cell& cell, std::size_t position, double radians);
  /// Walks from a cell over its edge `position` and opposite edges, over max_edges at most (no more than Walk holds).
  Walk walk(Cell cell, std::size_t position, std::size_t max_edges);

 private:
  ShellIndex only_neighbour(ShellIndex shell, EdgeIndex edge) const;
  ShellIndex shell_at(const Cell& cell, Edge edge) const;
  bool bends_little(const Cell& cell, Edge edge, EdgeIndex index, double radians);
  ShellIndex best_partner(ShellIndex shell) const;
  ShellIndex partner_of(ShellIndex shell);
  std::array<NodeIndex, 4> quad_of(ShellIndex shell, ShellIndex partner) const;
  Walk::Crossing crossing(Edge edge, const Vec3& from, const Vec3& into, const Vec3& normal) const;

  const Model& model_;
  OutOfSight out_of_sight_;
  std::vector<std::uint32_t> partner_;  ///< by shell
  std::vector<std::uint8_t> flat_;      ///< by edge: what is_flat_at found
};

}  // namespace prismesh::mesh::select
