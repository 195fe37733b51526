// Judging batch by batch. Inner to quality.
#pragma once

#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

/// Criteria for one target size, as plain limits.
struct Limits {
  std::array<Threshold, kMetricCount> quad;
  std::array<Threshold, kMetricCount> triangle;
  float warn_thicknesses = 0;
  float fail_thicknesses = 0;

  bool needs_thickness() const { return warn_thicknesses > 0 || fail_thicknesses > 0; }
};
Limits limits_for(const Criteria& criteria, double target_size);

/// Judges the first `count` lanes. `thickness` has one entry a lane, or is nullptr if none is needed.
void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const float* thickness, ShellState* out);

/// A shell's thickness: its own card's, else its section's; 0 if neither says.
inline float thickness_of(const Model& model, std::size_t shell) {
  if (const float own = model.shell_thickness[shell]; own > 0) return own;
  const PartIndex part = model.shell_parts[shell];
  if (!part.valid()) return 0;
  return static_cast<float>((*model.parts)[part.value].thickness.value_or(0.0));
}

}  // namespace prismesh::mesh::quality
