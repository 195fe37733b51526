// Turns mouse events into gestures: clicks, double clicks and drags. Knows no model and no picture.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "kiosk/display/window.h"
#include "kiosk/input/mouse_layout.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::input {

/// A point of the picture: x right, y down, from its upper left corner.
using Pixel = Eigen::Vector2d;

/// What lies under the pointer when a button goes down.
enum class Under : std::uint8_t { picture, panel, lift_handle, slide_handle, move_handle, turn_handle, falloff_ring, cut_handle, weld };

struct NodeClicked {
  Pixel at = Pixel::Zero();
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
  bool takes_away = false;  ///< by the button that takes away: where nothing can be taken, it opens the menu
};
struct RegionClicked {
  Pixel at = Pixel::Zero();  ///< of the first of the two clicks
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct TakeBackClicked {};
/// An outline while it is drawn: the pointer's path since the button went down. The tool makes a lasso of it, or the rectangle between its
/// ends.
struct OutlineDrawn {
  std::vector<Pixel> way;
  bool other_kind = false;
};
struct OutlineDone {
  std::vector<Pixel> way;
  bool other_kind = false;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct Orbited {
  double dx = 0, dy = 0;       ///< pixels since the last one
  Pixel from = Pixel::Zero();  ///< where the drag began
  Pixel at = Pixel::Zero();
};
struct Panned {
  double dx = 0, dy = 0;
  Pixel from = Pixel::Zero();
  Pixel at = Pixel::Zero();
};
struct Zoomed {
  Pixel at = Pixel::Zero();  ///< the fixed point of the zoom
  double steps = 0;          ///< positive: nearer
};
struct AngleTurned {
  double steps = 0;  ///< positive: wider
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

using Gesture = std::variant<NodeClicked, RegionClicked, TakeBackClicked, OutlineDrawn, OutlineDone, Orbited, Panned, Zoomed, AngleTurned,
                             HandleTaken, HandleMoved, HandleReleased>;

/// Whether the gesture selects, takes a selection back or takes a handle.
bool asks_for_edit(const Gesture& gesture);
/// The pixel that the gesture picks at: of its click, or where its outline begins.
std::optional<Pixel> picks_at(const Gesture& gesture);

/// How far the pointer may move during a click, in pixels; and how quickly the second click of a double click must follow.
inline constexpr double kClickRadius = 4;
inline constexpr std::int64_t kDoubleClickMs = 400;

/// Pixels between the points of an outline, and the most points that an edit may have.
inline constexpr double kOutlineStep = 2;
inline constexpr std::size_t kMaxOutlinePoints = 100'000;

/// Follows one mouse. A button pressed over a panel belongs to the panel until it is released. While something is drawn or pulled with one
/// button, another one may move the view: the drag waits meanwhile, and goes on when that button is up.
class Gestures {
 public:
  explicit Gestures(MouseLayout layout = default_mouse_layout()) : layout_(std::move(layout)) {}
  const MouseLayout& layout() const { return layout_; }

  std::vector<Gesture> moved(const display::PointerMoved& event);
  /// `under` counts only when the button goes down.
  std::vector<Gesture> button(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> wheel(const display::WheelTurned& event, Under under);

  /// Cancels the drag: releasing the button will do nothing. True: an outline or a handle was being dragged.
  bool cancel();

  /// The next click is no second one, as something else happened.
  void forget_click() { last_click_.reset(); }

  std::optional<Pixel> position() const { return position_; }
  void left() { position_.reset(); }
  /// Whether something in the picture follows the pointer: the view, an outline or a handle.
  bool dragging() const { return drag_ == Drag::outline || drag_ == Drag::view || drag_ == Drag::handle; }

 private:
  enum class Drag : std::uint8_t { none, panel, dead, pressed, outline, view, handle };
  /// The view being moved.
  struct Navigation {
    display::MouseButton button = display::MouseButton::left;
    DragDoes does = DragDoes::orbit;
    Pixel from = Pixel::Zero();
    Pixel last = Pixel::Zero();
  };

  std::vector<Gesture> pressed(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> second_pressed(const display::ButtonChanged& event, Under under);
  std::vector<Gesture> released(const display::ButtonChanged& event);
  std::vector<Gesture> clicked(const display::ButtonChanged& event);
  std::vector<Gesture> begin_drag(const Pixel& at);
  std::vector<Gesture> navigated(const Pixel& at);
  mesh::document::SelectMode mode() const;
  void lengthen(const Pixel& at);
  /// The button goes down near the last click and soon after it.
  bool second_click(std::int64_t time_ms) const;

  MouseLayout layout_;
  Drag drag_ = Drag::none;
  display::MouseButton button_ = display::MouseButton::left;
  display::Modifiers modifiers_;
  Pixel down_ = Pixel::Zero();
  std::vector<Pixel> way_;  ///< of an outline
  DragDoes outline_ = DragDoes::outline;
  std::optional<Navigation> navigation_;
  std::optional<Pixel> position_;
  std::optional<Pixel> last_click_;
  std::optional<Under> handle_below_;  ///< of a press that may become a click
  std::int64_t last_click_ms_ = 0;
};

}  // namespace prismesh::kiosk::input
