// A colour for each part by the state of its shells.
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
/// By PartIndex. `damaged`: counts only what the document's edits made worse.
std::vector<PartState> part_states(const ModelTable& table, bool damaged);
/// Grey while all is well; yellow where shells warn, red where some fail, the stronger the more of them do: full from a tenth on.
Colour colour_of_state(const PartState& state);

class PartLooks {
 public:
  /// Costs a pass over the shells. Errors: no graphics memory.
  Result<void> update(const ModelTable& table, bool damaged);
  const RowTexture& texture() const { return texture_; }
  std::size_t count() const { return count_; }

 private:
  RowTexture texture_{kTwoIndices};
  std::size_t count_ = 0;
};

}  // namespace prismesh::kiosk::render
