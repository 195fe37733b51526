// What the hand does with the pen's buttons: takes, pulls, lets go, and moves the pen's space. Pure; reads no clock.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/tools/pen/pen_place.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::pen {

/// What the pen holds, and how far it has brought it.
struct HeldByPen {
  Vec3 axis = Vec3::UnitZ();
  // Where it was when view or clutch moved last, and what the pen did then.
  Vec3 by = Vec3::Zero();
  double degrees = 0;
  Vec3 position_mm = Vec3::Zero();
  std::optional<Eigen::Quaterniond> orientation{};
  // Since then.
  Vec3 moved = Vec3::Zero();  ///< deck coordinates
  double turned = 0;
  bool beyond_slack = false;
};

class PenHand {
 public:
  /// A smaller motion is the hand's trembling: pressing and releasing the button without one pulls nothing.
  static constexpr double kSlackMm = 0.5;
  static constexpr double kSlackDegrees = 3;

  enum class Act : std::uint8_t {
    none,
    press,    ///< wants to take what is there: call `hold`, or nothing is held until the next press
    pull,     ///< what is held may have moved
    release,  ///< what was held stays where it is
    cancel,   ///< the pen is gone: what was held goes back
  };
  /// The pen as it is now, and where the view has the model.
  Act turn(const PenPose& pose, const Placement& in_view);

  /// There is no pen, or no model. Returns whether something was held, which goes back.
  bool leave();

  /// After a press: what is held turns about this axis (deck coordinates, unit).
  void hold(const Vec3& axis);
  /// Nothing is held any more. The button has to be released before it takes something again.
  void let_go() { held_.reset(); }
  bool holds() const { return held_.has_value(); }
  /// How far the pen has brought what is held, or what it released last, in the deck's unit and degrees. A motion of the view, or of the
  /// pen's space, doesn't change it.
  const mesh::document::Displacement& pulled() const { return pulled_; }

  /// Where the model is in the pen's space: as the view has it, moved by the clutch.
  const Placement& place() const { return place_; }
  /// The pen's space is again as the view has it.
  void forget_clutch() { clutch_mm_.setZero(); }

 private:
  void begin_anew(HeldByPen& held, const PenPose& pose) const;
  void follow(HeldByPen& held, const PenPose& pose);

  Vec3 clutch_mm_ = Vec3::Zero();
  Placement place_;
  std::optional<PenPose> before_;  ///< the last usable one; none: the pen was away
  std::optional<HeldByPen> held_;
  mesh::document::Displacement pulled_;
};

}  // namespace prismesh::kiosk::tools::pen
