// Lengthens the edges across a narrow row of quads between two feature lines, by sliding their ends along the lines: the edges lean, and
// the lines stay where they are. Refusals as in redivide.h.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Which way the edges across lean, as seen along the row.
enum class Lean : std::uint8_t {
  forward,
  back,
  forward_and_back,  ///< in turn, the first one forward
  back_and_forward,
};
struct RowSlide {
  LocalShell start;
  int edge = 0;  ///< of `start`: the row goes on across it and the opposite edge
  Lean lean = Lean::forward;
};

/// The ways to slide the row at a quad that has short edges between two lines; empty: it isn't such a quad.
std::vector<RowSlide> row_slides(const RepairContext& context, LocalShell shell);

/// Slides the ends of all edges across the row that are too short, as far as the row goes on between the lines.
Refusal slide_row(const RepairContext& context, const RowSlide& slide);

}  // namespace prismesh::mesh::repair
