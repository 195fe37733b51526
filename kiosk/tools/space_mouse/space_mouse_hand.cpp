#include "kiosk/tools/space_mouse/space_mouse_hand.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prismesh::kiosk::tools::space_mouse {
namespace {

constexpr std::uint64_t kFirstButton = 1, kSecondButton = 2;

/// The device's axes (right, toward the user, down) as the screen's (right, up, toward the user). Both are right-handed, so that turns
/// follow the same way.
Vec3 on_screen(const std::array<double, 3>& axes) { return {axes[0], -axes[2], axes[1]}; }

}  // namespace

stereo::View steered(const stereo::View& view, const SpaceMouseMotion& motion, double seconds, double height_mm) {
  const Vec3 shift = on_screen(motion.shift) * seconds, turn = on_screen(motion.turn) * seconds * kTurnRadians;
  stereo::View moved = stereo::pan(view, shift.head<2>() * kPanHeights * height_mm);
  moved = stereo::zoom(moved, std::exp(kZoomExponent * shift.z()), view.middle_mm);
  const double angle = turn.norm();
  if (angle > 0) moved.rotation = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * moved.rotation).normalized();
  return moved;
}

Vec3 carried(const stereo::View& view, const SpaceMouseMotion& motion, double seconds, double height_mm) {
  const Vec3 mm = on_screen(motion.shift) * (seconds * kMoveHeights * height_mm);
  return view.rotation.conjugate() * mm / view.mm_per_unit;
}

/// A motion begins with a step of 0: nobody knows how long before this turn it began.
double SpaceMouseHand::step_seconds(bool moves, std::int64_t now_ns) {
  const bool goes_on = moves && moved_before_;
  const std::int64_t step = goes_on ? std::clamp<std::int64_t>(now_ns - last_ns_, 0, kLongestStepNs) : 0;
  moved_before_ = moves;
  last_ns_ = now_ns;
  if (moves) deflected_ns_ = now_ns;
  return static_cast<double>(step) * 1e-9;
}

SpaceMouseHand::Answer SpaceMouseHand::turn(const Given& given, const stereo::View& view, double height_mm, std::int64_t now_ns) {
  const bool moves = !given.motion.at_rest();
  const double seconds = step_seconds(moves, now_ns);
  Answer answer;
  if (!given.there) {
    waits_for_rest_ = false;
    if (holds_) answer.act = Act::cancel;
    holds_ = false;
    return answer;
  }
  if ((given.pressed & (kFirstButton | kSecondButton)) != 0) {
    const bool held = holds_;
    if (held) {
      let_go();
      answer.act = Act::commit;
    }
    if ((given.pressed & kSecondButton) != 0) {
      mode_ = mode_ == Mode::view ? Mode::move : Mode::view;
      waits_for_rest_ = moves;  // what the cap does now was meant for the other mode
    }
    answer.fits = (given.pressed & kFirstButton) != 0 && !held;
    return answer;
  }
  if (waits_for_rest_) {
    waits_for_rest_ = moves;
    return answer;
  }
  if (mode_ == Mode::move) {
    answer.act = move(given, view, height_mm, seconds, now_ns);
  } else if (moves) {
    answer.act = Act::steer;
    answer.view = steered(view, given.motion, seconds, height_mm);
  }
  return answer;
}

SpaceMouseHand::Act SpaceMouseHand::move(const Given& given, const stereo::View& view, double height_mm, double seconds,
                                         std::int64_t now_ns) {
  const bool moves = !given.motion.at_rest();
  if (!holds_) {
    waits_for_rest_ = moves;  // until `hold`
    return moves ? Act::take : Act::none;
  }
  if (!moves) {
    if (now_ns - deflected_ns_ < kRestNs) return Act::none;
    holds_ = false;
    return Act::commit;
  }
  by_ += carried(view, given.motion, seconds, height_mm);
  return Act::pull;
}

void SpaceMouseHand::hold() {
  holds_ = true;
  waits_for_rest_ = false;
  by_.setZero();
}

void SpaceMouseHand::let_go() {
  holds_ = false;
  waits_for_rest_ = moved_before_;
}

}  // namespace prismesh::kiosk::tools::space_mouse
