#include "kiosk/tools/pen/pen_hand.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace prismesh::kiosk::tools::pen {
namespace {

bool is_same(const Placement& a, const Placement& b) { return a.turn == b.turn && a.shift_mm == b.shift_mm && a.scale == b.scale; }

/// The turn's part about an axis, degrees from -180 to 180.
double degrees_about(const Eigen::Quaterniond& turn, const Vec3& axis) {
  return 2 * std::atan2(turn.vec().dot(axis), turn.w()) * 180 / std::numbers::pi;
}

/// The same angle, as near as possible to another.
double near_to(double degrees, double other) { return degrees + 360 * std::round((other - degrees) / 360); }

}  // namespace

bool PenHand::leave() {
  before_.reset();
  return std::exchange(held_, std::nullopt).has_value();
}

PenHand::Act PenHand::turn(const PenPose& pose, const Placement& in_view) {
  if (pose.usable && before_ && pose.clutch && before_->clutch) clutch_mm_ += pose.position_mm - before_->position_mm;
  Placement place = in_view;
  place.shift_mm += clutch_mm_;
  const bool moved_space = !is_same(place, place_) || pose.clutch;
  place_ = place;
  if (!pose.usable) return leave() ? Act::cancel : Act::none;
  // A button that was down when the pen came takes nothing.
  const bool was_down = !before_ || before_->grab;
  before_ = pose;
  if (held_) {
    if (moved_space)
      begin_anew(*held_, pose);
    else
      follow(*held_, pose);
    if (pose.grab) return Act::pull;
    held_.reset();
    return Act::release;
  }
  return pose.grab && !was_down && !pose.clutch ? Act::press : Act::none;
}

void PenHand::hold(const Vec3& axis) {
  if (!before_) return;
  held_.emplace();
  pulled_ = {};
  held_->axis = axis;
  held_->position_mm = before_->position_mm;
  held_->orientation = before_->orientation;
}

/// What is held stays where it is; from now on it goes with the pen as it is now.
void PenHand::begin_anew(HeldByPen& held, const PenPose& pose) const {
  held.by += held.moved;
  held.degrees += held.turned;
  held.moved.setZero();
  held.turned = 0;
  held.position_mm = pose.position_mm;
  held.orientation = pose.orientation;
}

void PenHand::follow(HeldByPen& held, const PenPose& pose) {
  const Vec3 way_mm = pose.position_mm - held.position_mm;
  held.moved = place_.turn.transpose() * way_mm / place_.scale;
  if (held.orientation && pose.orientation) {
    const Eigen::Quaterniond turn = *pose.orientation * held.orientation->conjugate();
    held.turned = near_to(degrees_about(turn, place_.turn * held.axis), held.turned);
  }
  held.beyond_slack = held.beyond_slack || way_mm.norm() > kSlackMm || std::abs(held.turned) > kSlackDegrees;
  if (!held.beyond_slack) return;
  pulled_.by = held.by + held.moved;
  pulled_.degrees = held.degrees + held.turned;
}

}  // namespace prismesh::kiosk::tools::pen
