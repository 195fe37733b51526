#include "ipc/pen/page.h"

namespace prismesh::ipc {

std::string_view name(PenStage stage) {
  switch (stage) {
    case PenStage::none: return "none";
    case PenStage::absent: return "absent";
    case PenStage::setting_up: return "setting up";
    case PenStage::homing: return "homing";
    case PenStage::disarmed: return "disarmed";
    case PenStage::armed: return "armed";
    case PenStage::latched: return "latched";
  }
  return "unknown";
}

}  // namespace prismesh::ipc
