#include "kiosk/tools/gestures.h"

namespace prismesh::kiosk::tools {
namespace {

using display::MouseButton;
using mesh::document::SelectMode;

double distance(const Pixel& a, const Pixel& b) { return (a - b).norm(); }

SelectMode mode_for(const display::Modifiers& modifiers) {
  return modifiers.ctrl ? SelectMode::subtract : modifiers.shift ? SelectMode::add : SelectMode::set;
}

}  // namespace

std::vector<Gesture> Gestures::moved(const display::PointerMoved& event) {
  const Pixel at(event.x, event.y);
  position_ = at;
  if (drag_ == Drag::pressed && distance(at, down_) > kClickRadius) {
    if (handle_below_) {
      last_click_.reset();
      drag_ = Drag::handle;
      last_ = at;
      return {HandleTaken{*handle_below_, down_}, HandleMoved{at}};
    }
    begin_drag();
  }
  const Pixel before = last_;
  last_ = at;
  switch (drag_) {
    case Drag::rectangle: return {RectangleStretched{down_, at}};
    case Drag::orbit: return {Orbited{at.x() - before.x(), at.y() - before.y(), down_}};
    case Drag::pan: return {Panned{at.x() - before.x(), at.y() - before.y(), down_}};
    case Drag::handle: return {HandleMoved{at}};
    default: return {};
  }
}

void Gestures::begin_drag() {
  last_click_.reset();
  if (button_ == MouseButton::middle || (button_ == MouseButton::right && modifiers_.alt))
    drag_ = Drag::pan;
  else if (button_ == MouseButton::right || modifiers_.alt)
    drag_ = Drag::orbit;
  else
    drag_ = Drag::rectangle;
  last_ = down_;
}

std::vector<Gesture> Gestures::button(const display::ButtonChanged& event, Under under) {
  position_ = Pixel(event.x, event.y);
  if (event.down) return drag_ == Drag::none ? pressed(event, under) : std::vector<Gesture>{};  // a second button changes nothing
  return event.button == button_ ? released(event) : std::vector<Gesture>{};
}

std::vector<Gesture> Gestures::pressed(const display::ButtonChanged& event, Under under) {
  button_ = event.button;
  modifiers_ = event.modifiers;
  down_ = last_ = Pixel(event.x, event.y);
  const bool handle =
      (under == Under::lift_handle || under == Under::move_handle) && event.button == MouseButton::left && !event.modifiers.alt;
  handle_below_.reset();
  if (under == Under::panel) {
    drag_ = Drag::panel;
  } else if (handle && second_click(event.time_ms)) {
    // The first click has put the handle under the pointer, perhaps before the second one came.
    handle_below_ = under;
    drag_ = Drag::pressed;
  } else if (handle) {
    drag_ = Drag::handle;
    return {HandleTaken{under, down_}};
  } else {
    drag_ = Drag::pressed;
  }
  return {};
}

bool Gestures::second_click(std::int64_t time_ms) const {
  return last_click_ && distance(*last_click_, down_) <= kClickRadius && time_ms - last_click_ms_ <= kDoubleClickMs;
}

std::vector<Gesture> Gestures::released(const display::ButtonChanged& event) {
  const Drag was = drag_;
  drag_ = Drag::none;
  const Pixel at(event.x, event.y);
  switch (was) {
    case Drag::pressed: return clicked(event);
    case Drag::rectangle: return {RectangleDone{down_, at, mode_for(modifiers_)}};
    case Drag::handle: return {HandleReleased{at}};
    default: return {};
  }
}

std::vector<Gesture> Gestures::clicked(const display::ButtonChanged& event) {
  if (modifiers_.alt) return {};
  if (event.button == MouseButton::middle) return {TakeBackClicked{}};
  if (event.button == MouseButton::right) return {NodeClicked{down_, SelectMode::subtract}};
  const SelectMode mode = mode_for(modifiers_);
  if (second_click(event.time_ms)) {
    const Pixel first = *last_click_;
    last_click_.reset();
    return {RegionClicked{first, mode}};
  }
  last_click_ = down_;
  last_click_ms_ = event.time_ms;
  return {NodeClicked{down_, mode}};
}

std::vector<Gesture> Gestures::wheel(const display::WheelTurned& event, Under under) {
  position_ = Pixel(event.x, event.y);
  if (under == Under::panel) return {};
  return {Zoomed{Pixel(event.x, event.y), event.steps}};
}

bool Gestures::cancel() {
  const bool something = drag_ == Drag::rectangle || drag_ == Drag::handle;
  if (drag_ != Drag::none) drag_ = Drag::dead;
  last_click_.reset();
  return something;
}

}  // namespace prismesh::kiosk::tools
