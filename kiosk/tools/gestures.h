// From mouse events to gestures: what is a click, a double click, a drag, and of what. Knows nothing of models or pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "kiosk/display/window.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools {

/// A point of the picture: x right, y down, from its upper left corner.
using Pixel = Eigen::Vector2d;

/// What lies under the pointer when a button goes down.
enum class Under : std::uint8_t { picture, panel, lift_handle, move_handle };

struct NodeClicked {
  Pixel at = Pixel::Zero();
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct RegionClicked {
  Pixel at = Pixel::Zero();  ///< of the first of the two clicks
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct TakeBackClicked {};
struct RectangleStretched {
  Pixel from = Pixel::Zero(), to = Pixel::Zero();
};
struct RectangleDone {
  Pixel from = Pixel::Zero(), to = Pixel::Zero();
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct Orbited {
  double dx = 0, dy = 0;       ///< pixels since the last one
  Pixel from = Pixel::Zero();  ///< where the drag began
};
struct Panned {
  double dx = 0, dy = 0;
  Pixel from = Pixel::Zero();
};
struct Zoomed {
  Pixel at = Pixel::Zero();
  double steps = 0;  ///< positive: nearer
};
struct HandleTaken {
  Under handle = Under::lift_handle;
  Pixel at = Pixel::Zero();
};
struct HandleMoved {
  Pixel at = Pixel::Zero();
};
struct HandleReleased {
  Pixel at = Pixel::Zero();
};

using Gesture = std::variant<NodeClicked, RegionClicked, TakeBackClicked, RectangleStretched, RectangleDone, Orbited, Panned, Zoomed,
                             HandleTaken, HandleMoved, HandleReleased>;

/// How far a pressed pointer may wander and still be a click, in pixels; and how quickly a second click must follow.
inline constexpr double kClickRadius = 4;
inline constexpr std::int64_t kDoubleClickMs = 400;

/// Follows one mouse. A button pressed over a panel belongs to the panel until it is released.
class Gestures {
 public:
  std::vector<Gesture> moved(const display::PointerMoved& event);
  /// `under` is looked at when the button goes down only.
  std::vector<Gesture> button(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> wheel(const display::WheelTurned& event, Under under);

  /// Gives up what is under way: releasing the button will do nothing. True if a rectangle or a handle was being dragged.
  bool cancel();

  /// Something else was done: the next click is no second one.
  void forget_click() { last_click_.reset(); }

  std::optional<Pixel> position() const { return position_; }
  void left() { position_.reset(); }
  /// Whether something in the picture follows the pointer: the view, a rectangle or a handle.
  bool dragging() const { return drag_ == Drag::rectangle || drag_ == Drag::orbit || drag_ == Drag::pan || drag_ == Drag::handle; }

 private:
  enum class Drag : std::uint8_t { none, panel, dead, pressed, rectangle, orbit, pan, handle };

  std::vector<Gesture> pressed(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> released(const display::ButtonChanged& event);
  std::vector<Gesture> clicked(const display::ButtonChanged& event);
  void begin_drag();
  /// The button goes down where and soon after it was clicked.
  bool second_click(std::int64_t time_ms) const;

  Drag drag_ = Drag::none;
  display::MouseButton button_ = display::MouseButton::left;
  display::Modifiers modifiers_;
  Pixel down_ = Pixel::Zero();
  Pixel last_ = Pixel::Zero();
  std::optional<Pixel> position_;
  std::optional<Pixel> last_click_;
  std::optional<Under> handle_below_;  ///< of a press that may become a double click
  std::int64_t last_click_ms_ = 0;
};

}  // namespace prismesh::kiosk::tools
