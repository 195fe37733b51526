// Finds fillets: a sheet that bends by more than an angle within a few rows of quads, between parts of it that are flatter.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"
#include "mesh/select/in_sight.h"

namespace prismesh::mesh::select {

/// Decides for one shell at a time and remembers the answer. Across opposite edges of quads, rows of a fillet bend to the same side, each
/// with at least 3/10 of the greatest curvature among them (bend by the width of the narrower shell). There are 8 rows at most; together
/// they bend by more than the angle. At least on one side the sheet beyond has at most 3/20 of that curvature from the second edge on, and
/// on the other side too, or it ends there, or it bends back. So a tube, a dome and a corrugated sheet are no fillets.
class Fillets {
 public:
  /// Keeps references; `model` needs its adjacency.
  Fillets(const Model& model, double angle_degrees, OutOfSight out_of_sight);

  /// 0 if the shell is in no fillet; else bit 0 if the fillet bends across the quad's edges 0-1 and 2-3, bit 1 if across 1-2 and 3-0.
  int directions(ShellIndex shell);
  /// Whether the shell is in a fillet that bends across this edge of it.
  bool bends_across(ShellIndex shell, Edge edge);

 private:
  const Model& model_;
  double angle_degrees_;
  OutOfSight out_of_sight_;
  std::vector<std::uint8_t> known_;  ///< for each shell 0: not yet asked; else 4 + directions
};

}  // namespace prismesh::mesh::select
