// Judges shells batch by batch. Inner to quality.
#pragma once

#include <cstddef>

#include "mesh/model/model.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/sheet.h"
#include "mesh/quality/shell_lanes.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

/// Judges the first `count` lanes. `sheets` has one entry a lane, or is nullptr if none is needed.
void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const Sheet* sheets, ShellState* out);
/// Composites of the lanes.
void rate_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const Sheet* sheets, float* out);

/// The sheets of a batch of the model's shells, if they are needed. `shell_of(slot)` is the shell in a slot. nullptr if not needed.
template <class ShellOf>
const Sheet* sheets_of(const Model& model, const Limits& limits, const ShellBatch& batch, const ShellOf& shell_of, Sheet* room) {
  if (!limits.need_sheets()) return nullptr;
  for (std::size_t lane = 0; lane < batch.count; ++lane) room[lane] = sheet_of(model, ShellIndex(shell_of(batch.slot[lane])));
  return room;
}

}  // namespace prismesh::mesh::quality
