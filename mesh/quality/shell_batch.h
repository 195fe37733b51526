// Measures shells in batches of one shape: coordinates are gathered lane by lane, and all metrics of a batch are computed in loops that the
// compiler vectorises. For mesh/quality, mesh/relax and mesh/repair.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mesh/model/model.h"
#include "mesh/quality/shell_lanes.h"

namespace prismesh::mesh::quality {

/// Computes all metrics of a batch. Gives the same bits for a shell whatever its lane, its neighbours and the processor.
void measure_quads(const ShellBatch& batch, BatchValues& values);
void measure_triangles(const ShellBatch& batch, BatchValues& values);

enum class Shape : std::uint8_t { quad, triangle, none };

/// Computes areas, moments and characteristic lengths of a batch; `shell_option`: ISDO (mesh/quality/time_step.h).
void extend_quads(const ShellBatch& batch, int shell_option, BatchExtents& extents);
void extend_triangles(const ShellBatch& batch, int shell_option, BatchExtents& extents);

/// Measures `count` shells. `corners(i, corner)` puts pointers to the four corner positions of shell i into `corner` and returns its shape;
/// shells of Shape::none (removed ones) are skipped. Calls `sink(batch, values)` for every batch, full or not.
template <class CornersOf, class Sink>
void measure_in_batches(std::size_t count, const CornersOf& corners, const Sink& sink) {
  ShellBatch quads, triangles;
  BatchValues values;
  const auto flush = [&](ShellBatch& batch, auto* measure) {
    if (batch.count == 0) return;
    // spare lanes repeat the first, so that they hold numbers
    for (std::size_t lane = batch.count; lane < batch.padded(); ++lane)
      for (auto& corner : batch.p)
        for (auto& axis : corner) axis[lane] = axis[0];
    measure(batch, values);
    sink(static_cast<const ShellBatch&>(batch), static_cast<const BatchValues&>(values));
    batch.count = 0;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3* corner[4];
    const Shape shape = corners(i, corner);
    if (shape == Shape::none) continue;
    const bool is_triangle = shape == Shape::triangle;
    ShellBatch& batch = is_triangle ? triangles : quads;
    const std::size_t lane = batch.count++;
    batch.slot[lane] = static_cast<std::uint32_t>(i);
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t axis = 0; axis < 3; ++axis) batch.p[c][axis][lane] = (*corner[c])[static_cast<Eigen::Index>(axis)];
    if (batch.count == kLanes) {
      if (is_triangle)
        flush(triangles, measure_triangles);
      else
        flush(quads, measure_quads);
    }
  }
  flush(quads, measure_quads);
  flush(triangles, measure_triangles);
}

/// Corner positions of a model's shell, for measure_in_batches.
inline Shape corners_of(const Model& model, std::size_t shell, const Vec3* (&corner)[4]) {
  const ShellNodes& nodes = model.shell_nodes[shell];
  if (!nodes.node[0].valid()) return Shape::none;
  for (std::size_t c = 0; c < 4; ++c) corner[c] = &model.position(nodes.node[c]);
  return nodes.is_triangle() ? Shape::triangle : Shape::quad;
}

}  // namespace prismesh::mesh::quality
