// Judges shells batch by batch. For mesh/quality, mesh/relax and mesh/repair.
#pragma once

#include <cstddef>

#include "mesh/model/model.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/shell_lanes.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

/// Judges the first `count` lanes into `out`. `properties` has an entry for each lane, or is nullptr if none is needed (or known).
void judge_lanes(const BatchValues& values, std::size_t count, const LimitsByPart& limits, const ShellProperties* properties,
                 ShellState* out);
/// Puts the composites of the first `count` lanes into `out`. `properties`: as in judge_lanes.
void rate_lanes(const BatchValues& values, std::size_t count, const LimitsByPart& limits, const ShellProperties* properties, float* out);
/// The same for lanes that are all judged by the same limits.
void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const ShellProperties* properties, ShellState* out);
void rate_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const ShellProperties* properties, float* out);

/// Gathers the properties of a batch of the model's shells in `buffer`, if the limits need them; nullptr if not. `shell_of(slot)` is the
/// shell in a slot.
template <class ShellOf>
const ShellProperties* batch_properties(const Model& model, const LimitsByPart& limits, const ShellBatch& batch, const ShellOf& shell_of,
                                        ShellProperties* buffer) {
  if (!limits.need_properties()) return nullptr;
  if (!limits.needs_material) {
    for (std::size_t lane = 0; lane < batch.count; ++lane) buffer[lane].part = model.shell_parts[shell_of(batch.slot[lane])];
    return buffer;
  }
  for (std::size_t lane = 0; lane < batch.count; ++lane) buffer[lane] = properties_of(model, ShellIndex(shell_of(batch.slot[lane])));
  return buffer;
}

}  // namespace prismesh::mesh::quality
