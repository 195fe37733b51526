#include "kiosk/tools/shaping/pull_preview.h"

#include <fmt/format.h>

namespace prismesh::kiosk::tools::shaping {

Result<void> PullPreview::follow() {
  const link::RunningDrag* drag = drag_.running();
  if (drag == nullptr) {
    if (shown_) renderer_.end_preview();
    shown_ = false;
    sequence_ = 0;
    return {};
  }
  if (!drag->begun() || drag->frame().sequence == sequence_) return {};
  if (!shown_) renderer_.begin_preview(drag->preview().nodes(), drag->preview().shells());
  shown_ = true;
  sequence_ = drag->frame().sequence;
  if (Result<void> updated = renderer_.update_preview(drag->frame()); !updated) return updated;
  trace_.line(fmt::format("drag shown {} warn {} fail {}", sequence_, drag->frame().counts.warn, drag->frame().counts.fail));
  return {};
}

}  // namespace prismesh::kiosk::tools::shaping
