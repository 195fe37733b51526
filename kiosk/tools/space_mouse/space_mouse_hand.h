// What the hand does with a SpaceMouse: turns, moves and scales the view, or moves the selection. Pure; times are passed in.
#pragma once

#include <cstdint>

#include "drivers/space_mouse/response.h"
#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::tools::space_mouse {

using drivers::space_mouse::SpaceMouseMotion;
using mesh::Vec3;

// At full deflection, in a second.
inline constexpr double kTurnRadians = 2.1;
inline constexpr double kPanHeights = 1;      ///< heights of the view
inline constexpr double kZoomExponent = 1.2;  ///< larger or smaller by e to this
inline constexpr double kMoveHeights = 0.25;  ///< of the selection: finer than of the view

/// The view after so many seconds with the cap held so: the model goes where the cap goes. Pushed right and up it moves so, pulled toward
/// the user it grows about the view's middle, and it turns about its pivot as the cap turns. `height_mm`: of the view on the screen.
stereo::View steered(const stereo::View& view, const SpaceMouseMotion& motion, double seconds, double height_mm);
/// How far the selection goes meanwhile, in deck coordinates: to the right, up and toward the user as the screen shows them.
Vec3 carried(const stereo::View& view, const SpaceMouseMotion& motion, double seconds, double height_mm);

class SpaceMouseHand {
 public:
  /// A picture may take longer: no step is larger than that.
  static constexpr std::int64_t kLongestStepNs = 100'000'000;
  /// The cap at rest for so long ends a move.
  static constexpr std::int64_t kRestNs = 500'000'000;

  enum class Mode : std::uint8_t { view, move };
  enum class Act : std::uint8_t {
    none,
    steer,   ///< the view moves: see `view`
    take,    ///< wants to move the selection: call `hold`, or nothing is held until the cap has rested
    pull,    ///< the selection may have moved: see `by`
    commit,  ///< it stays where it is
    cancel,  ///< the device is gone: it goes back
  };
  /// The devices as they are now.
  struct Given {
    SpaceMouseMotion motion;
    std::uint64_t pressed = 0;  ///< buttons that went down, a bit each
    bool there = false;         ///< a device is plugged in
  };
  struct Answer {
    Act act = Act::none;
    bool fits = false;  ///< the view is to show all
    stereo::View view;  ///< with `steer`
  };
  Answer turn(const Given& given, const stereo::View& view, double height_mm, std::int64_t now_ns);

  void hold();
  /// Nothing is held any more. The cap has to rest before something is moved again.
  void let_go();
  bool holds() const { return holds_; }
  Mode mode() const { return mode_; }
  /// How far it has brought what is held, or what it held last; deck coordinates.
  const Vec3& by() const { return by_; }

 private:
  Act move(const Given& given, const stereo::View& view, double height_mm, double seconds, std::int64_t now_ns);
  double step_seconds(bool moves, std::int64_t now_ns);

  Mode mode_ = Mode::view;
  bool moved_before_ = false;  ///< the cap was deflected at the last turn
  std::int64_t last_ns_ = 0;
  std::int64_t deflected_ns_ = 0;  ///< when it was last
  bool holds_ = false;
  bool waits_for_rest_ = false;
  Vec3 by_ = Vec3::Zero();
};

}  // namespace prismesh::kiosk::tools::space_mouse
