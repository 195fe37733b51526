// Finds fillets: a sheet that bends by more than an angle within a few rows of quads, between parts of it that are flatter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::select {

struct Cell;
class Cells;

/// Decides for one shell at a time and remembers the answer. Two triangles that together make a quad count as one. Across opposite edges of
/// quads, rows of a fillet bend to the same side, each with at least 3/10 of the greatest curvature among them (bend by the width of the
/// narrower shell). There are 8 rows at most; together they bend by more than the angle. At least on one side the sheet beyond has at most
/// 3/20 of that curvature from the second edge on, and on the other side too, or it ends there, or it bends back. So a tube, a dome and a
/// corrugated sheet are no fillets. Rows that bend so, but beside which the sheet isn't flat (a bead ends there), belong to the fillet that
/// they continue on both sides along its axis, or on one side if the sheet ends on the other. So do up to three columns between, where a
/// bead ends in the fillet.
class Fillets {
 public:
  /// Keeps references; `model` needs its adjacency.
  Fillets(const Model& model, double angle_degrees, OutOfSight out_of_sight);
  ~Fillets();

  /// 0 if the shell is in no fillet. For a quad, bit 0 if the fillet bends across its edges 0-1 and 2-3, bit 1 if across 1-2 and 3-0.
  int directions(ShellIndex shell);
  /// Whether the shell is in a fillet that bends across this edge of it.
  bool bends_across(ShellIndex shell, Edge edge);

 private:
  int rows_across(const Cell& cell, std::size_t first);
  std::optional<bool> goes_on(Cell cell, std::size_t position, int crooked);
  bool is_fillet_across(const Cell& cell, std::size_t first);
  int directions_of_triangle(ShellIndex shell);

  static constexpr int kLoneTriangle = 4;
  static constexpr int kAsked = 8;

  const Model& model_;
  double angle_degrees_;
  std::unique_ptr<Cells> cells_;
  std::vector<std::uint8_t> known_;  ///< for each shell 0: not yet asked; else kAsked + directions
  std::vector<std::uint8_t> rows_;   ///< for each shell that keeps a cell's answers: four bits a direction, 8 + Rows once asked
};

}  // namespace prismesh::mesh::select
