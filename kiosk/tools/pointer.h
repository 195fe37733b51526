// From mouse events to gestures: what is a click, a double click, a drag, and of what. Knows nothing of models or pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "kiosk/display/window.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools {

/// A point of the picture, pixels from its upper left corner.
struct ScreenPoint {
  double x = 0, y = 0;
};

/// What lies under the pointer when a button goes down.
enum class Under : std::uint8_t { picture, panel, lift_handle, move_handle };

struct NodeClicked {
  ScreenPoint at;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct RegionClicked {
  ScreenPoint at;  ///< of the first of the two clicks
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct TakeBackClicked {};
struct RectangleStretched {
  ScreenPoint from, to;
};
struct RectangleDone {
  ScreenPoint from, to;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct Orbited {
  double dx = 0, dy = 0;  ///< pixels since the last one
  ScreenPoint from;       ///< where the drag began
};
struct Panned {
  double dx = 0, dy = 0;
  ScreenPoint from;
};
struct Zoomed {
  ScreenPoint at;
  double steps = 0;  ///< positive: nearer
};
struct HandleTaken {
  Under handle = Under::lift_handle;
  ScreenPoint at;
};
struct HandleMoved {
  ScreenPoint at;
};
struct HandleReleased {
  ScreenPoint at;
};

using Gesture = std::variant<NodeClicked, RegionClicked, TakeBackClicked, RectangleStretched, RectangleDone, Orbited, Panned, Zoomed,
                             HandleTaken, HandleMoved, HandleReleased>;

/// How far a pressed pointer may wander and still be a click, in pixels; and how quickly a second click must follow.
inline constexpr double kClickRadius = 4;
inline constexpr std::int64_t kDoubleClickMs = 400;

/// Follows one mouse. A button pressed over a panel belongs to the panel until it is released.
class Pointer {
 public:
  std::vector<Gesture> moved(const display::PointerMoved& event);
  /// `under` is looked at when the button goes down only.
  std::vector<Gesture> button(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> wheel(const display::WheelTurned& event, Under under);

  /// Gives up what is under way: releasing the button will do nothing. True if a rectangle or a handle was being dragged.
  bool cancel();

  std::optional<ScreenPoint> position() const { return position_; }
  void left() { position_.reset(); }
  /// Whether moves belong to a drag in the picture.
  bool dragging() const { return drag_ != Drag::none && drag_ != Drag::panel && drag_ != Drag::dead; }

 private:
  enum class Drag : std::uint8_t { none, panel, dead, pressed, rectangle, orbit, pan, handle };

  std::vector<Gesture> pressed(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> released(const display::ButtonChanged& event);
  std::vector<Gesture> clicked(const display::ButtonChanged& event);
  void begin_drag();

  Drag drag_ = Drag::none;
  display::MouseButton button_ = display::MouseButton::left;
  display::Modifiers modifiers_;
  ScreenPoint down_;
  ScreenPoint last_;
  std::optional<ScreenPoint> position_;
  std::optional<ScreenPoint> last_click_;
  std::int64_t last_click_ms_ = 0;
};

}  // namespace prismesh::kiosk::tools
