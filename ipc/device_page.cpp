#include "ipc/device_page.h"

namespace prismesh::ipc {

drivers::eye_tracker::HeadState EyesState::head() const {
  drivers::eye_tracker::HeadState state;
  state.time_ns = measured_ns;
  state.between_eyes_mm = Eigen::Vector3d(between_eyes_mm.data());
  state.velocity_mm_s = Eigen::Vector3d(velocity_mm_s.data());
  state.toward_right = Eigen::Vector3d(toward_right.data());
  return state;
}

}  // namespace prismesh::ipc
