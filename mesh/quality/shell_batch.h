// The fused pass: shells are gathered into batches of one shape, coordinates lane by lane, and all metrics of a batch are
// computed in loops that the compiler turns into vector code. Inner to quality.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mesh/model/model.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

inline constexpr std::size_t kLanes = 64;

/// Corner coordinates of up to kLanes shells of one shape.
struct ShellBatch {
  alignas(64) double p[4][3][kLanes];  ///< [corner][axis][lane]; a triangle's fourth corner is unused
  std::uint32_t slot[kLanes];          ///< what the lane's shell is to the caller
  std::size_t count = 0;

  /// The lanes that are computed: the used ones, and spare ones up to a whole number of vectors.
  std::size_t padded() const { return (count + 7) / 8 * 8; }
};

/// What defects do to the values, so that they can be told from them: a shell that isn't finite has none, one with corners at one
/// place has exactly this aspect, one without area exactly this skew, and no other shell has.
inline constexpr float kRepeatedAspect = 1e9F;
inline constexpr float kNoAreaSkew = 90.0F;

/// Of the longest edge squared: with twice its area below that, a shell has none.
inline constexpr double kMinArea = 1e-10;

/// Metrics lane by lane, indexed by Metric; those that don't apply are NaN.
struct BatchValues {
  alignas(64) float value[kMetricCount][kLanes];
  bool of_triangles = false;

  Values at(std::size_t lane) const {
    Values values;
    for (int m = 0; m < kMetricCount; ++m) values[m] = value[m][lane];
    return values;
  }
};

/// What mass and time step follow from, lane by lane.
struct BatchExtents {
  alignas(64) double area[kLanes];         ///< of the two triangles that p0 p2 cuts a quad into
  alignas(64) double moment[3][kLanes];    ///< area times place
  alignas(64) double step_length[kLanes];  ///< characteristic_length(), mesh/quality/time_step.h
};

/// One shell's values in the first lane, as they came from there. A shell without any counts as a triangle:
/// it has a defect anyhow.
inline BatchValues batch_of(const Values& values) {
  BatchValues batch;
  for (int m = 0; m < kMetricCount; ++m) batch.value[m][0] = values[m];
  const float warpage = values[int(Metric::warpage)];
  batch.of_triangles = !(warpage == warpage);  // it applies to quads only
  return batch;
}

/// All metrics of a batch. The same bits for a shell whatever its lane, its neighbours and the processor.
void measure_quads(const ShellBatch& batch, BatchValues& values);
void measure_triangles(const ShellBatch& batch, BatchValues& values);

enum class Shape : std::uint8_t { quad, triangle, none };

void extend_quads(const ShellBatch& batch, int shell_option, BatchExtents& extents);
void extend_triangles(const ShellBatch& batch, int shell_option, BatchExtents& extents);

/// Measures `count` shells: `corners(i, corner)` puts the four corner positions of shell i into `corner` as pointers and returns its
/// shape; one without (it was removed) is passed over. `sink(batch, values)` gets every full batch and the rests.
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
