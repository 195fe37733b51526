// Judging batch by batch. Inner to quality.
#pragma once

#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

/// One end of a metric's range on the scale of the composite: (value - limit) * per is 0 at the fail limit and 1 where it is ideal.
struct Side {
  float limit = std::numeric_limits<float>::quiet_NaN();  ///< NaN: no fail limit
  float per = 0;
};

/// Criteria for one target size, as plain limits of one shape's metrics.
struct ShapeLimits {
  std::array<Threshold, kMetricCount> threshold;
  std::array<std::array<Side, 2>, kMetricCount> side;
  float ideal_min_length = 0;
};
struct Limits {
  ShapeLimits quad, triangle;
  float warn_thicknesses = 0;
  float fail_thicknesses = 0;
  float warn_step = 0;  ///< least min_length for a wave speed of 1
  float fail_step = 0;

  const ShapeLimits& of(const BatchValues& values) const { return values.of_triangles ? triangle : quad; }
  bool need_sheets() const { return warn_thicknesses > 0 || fail_thicknesses > 0 || warn_step > 0 || fail_step > 0; }
};
Limits limits_for(const Criteria& criteria, double target_size);

/// Judges the first `count` lanes. `sheets` has one entry a lane, or is nullptr if none is needed.
void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const Sheet* sheets, ShellState* out);
/// Composites of the lanes.
void rate_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const Sheet* sheets, float* out);
/// The least min_length a lane may have, where the criteria look at sheets.
void least_lengths(const ShapeLimits& shape, const Limits& limits, const Sheet* sheets, std::size_t count, float* warn, float* fail);

/// The sheets of a batch of the model's shells, if they are needed. `shell_of(slot)` is the shell in a slot. nullptr if not needed.
template <class ShellOf>
const Sheet* sheets_of(const Model& model, const Limits& limits, const ShellBatch& batch, const ShellOf& shell_of, Sheet* room) {
  if (!limits.need_sheets()) return nullptr;
  for (std::size_t lane = 0; lane < batch.count; ++lane) room[lane] = sheet_of(model, ShellIndex(shell_of(batch.slot[lane])));
  return room;
}

/// A shell's thickness: its own card's, else its section's; 0 if neither says.
inline float thickness_of(const Model& model, std::size_t shell) {
  if (const float own = model.shell_thickness[shell]; own > 0) return own;
  const PartIndex part = model.shell_parts[shell];
  if (!part.valid()) return 0;
  return static_cast<float>((*model.parts)[part.value].thickness.value_or(0.0));
}

}  // namespace prismesh::mesh::quality
