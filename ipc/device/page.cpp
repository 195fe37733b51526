#include "ipc/device/page.h"

namespace prismesh::ipc {

std::string_view name(EyesPhase phase) {
  switch (phase) {
    case EyesPhase::none: return "none";
    case EyesPhase::absent: return "absent";
    case EyesPhase::silent: return "silent";
    case EyesPhase::searching: return "searching";
    case EyesPhase::tracking: return "tracking";
  }
  return "unknown";
}

drivers::eye_tracker::HeadState EyesState::head() const {
  drivers::eye_tracker::HeadState state;
  state.time_ns = measured_ns;
  state.between_eyes_mm = Eigen::Vector3d(between_eyes_mm.data());
  state.velocity_mm_s = Eigen::Vector3d(velocity_mm_s.data());
  state.toward_right = Eigen::Vector3d(toward_right.data());
  return state;
}

}  // namespace prismesh::ipc
