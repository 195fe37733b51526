// Colours each part by the grades of its shells.
#pragma once

#include <cstddef>
#include <vector>

#include "kiosk/render/model_table.h"
#include "kiosk/render/palette.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

struct PartState {
  std::size_t shells = 0, warn = 0, fail = 0;
};
/// Counts the shells of each part by grade; by PartIndex. `damaged`: counts only what the document's edits made worse.
std::vector<PartState> part_states(const ModelTable& table, bool damaged);
/// Grey if all shells pass, yellow if shells warn, red if some fail. The colour is stronger the more shells do, full from a tenth of them
/// on.
Colour colour_of_state(const PartState& state);

class PartLooks {
 public:
  /// Computes and uploads the colours. Costs a pass over the shells. Errors: no graphics memory.
  Result<void> update(const ModelTable& table, bool damaged);
  const RowTexture& texture() const { return texture_; }
  std::size_t count() const { return count_; }

 private:
  RowTexture texture_{kTwoIndices};
  std::size_t count_ = 0;
};

}  // namespace prismesh::kiosk::render
