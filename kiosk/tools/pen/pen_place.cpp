#include "kiosk/tools/pen/pen_place.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::tools::pen {
namespace {

constexpr std::uint32_t kGrabButton = 1, kClutchButton = 2;
const Vec3 kHeldByRightHand = Vec3(0.45, 0.5, 0.74).normalized();

template <std::size_t kCount>
bool finite_numbers(const std::array<double, kCount>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); });
}

bool is_present(ipc::PenStage stage) {
  return stage == ipc::PenStage::disarmed || stage == ipc::PenStage::armed || stage == ipc::PenStage::latched;
}

}  // namespace

Placement place_in_view(const stereo::View& view, double mm_per_unit) {
  Placement place;
  place.turn = view.rotation.normalized().toRotationMatrix();
  place.scale = mm_per_unit;
  place.shift_mm = -mm_per_unit * (place.turn * stereo::to_deck(view, Vec3::Zero()));
  return place;
}

link::PenPlace told_place(const Placement& place, std::uint64_t document) {
  const Eigen::Quaterniond turn(place.turn);
  link::PenPlace told;
  told.turn = {turn.w(), turn.x(), turn.y(), turn.z()};
  told.shift_mm = {place.shift_mm.x(), place.shift_mm.y(), place.shift_mm.z()};
  told.scale = place.scale;
  told.document = document;
  return told;
}

bool can_be_shown(const ipc::PenState& state, std::int64_t now_ns) {
  return is_present(state.stage) && state.measured_ns != 0 && now_ns - state.measured_ns < kSilenceNs && finite_numbers(state.position_mm);
}

PenPose pose_of(const ipc::PenState& state, std::int64_t now_ns) {
  PenPose pose;
  if (!can_be_shown(state, now_ns)) return pose;
  pose.usable = state.stage != ipc::PenStage::latched;
  pose.position_mm = Vec3(state.position_mm.data());
  const auto& [w, x, y, z] = state.orientation;
  const Eigen::Quaterniond orientation(w, x, y, z);
  if (state.has_orientation && finite_numbers(state.orientation) && orientation.norm() > 0.5) pose.orientation = orientation.normalized();
  pose.grab = (state.buttons & kGrabButton) != 0;
  pose.clutch = (state.buttons & kClutchButton) != 0;
  return pose;
}

Vec3 shaft_of(const PenPose& pose, bool left_handed) {
  if (pose.orientation) return *pose.orientation * Vec3::UnitZ();
  return left_handed ? Vec3(-kHeldByRightHand.x(), kHeldByRightHand.y(), kHeldByRightHand.z()) : kHeldByRightHand;
}

}  // namespace prismesh::kiosk::tools::pen
