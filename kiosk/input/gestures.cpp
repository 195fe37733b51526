#include "kiosk/input/gestures.h"

namespace prismesh::kiosk::input {
namespace {

using display::MouseButton;
using mesh::document::SelectMode;

constexpr double kPixelsPerZoomStep = 30;

double distance(const Pixel& a, const Pixel& b) { return (a - b).norm(); }

bool moves_view(DragDoes does) { return does == DragDoes::orbit || does == DragDoes::pan || does == DragDoes::zoom; }

}  // namespace

bool asks_for_edit(const Gesture& gesture) {
  return std::holds_alternative<NodeClicked>(gesture) || std::holds_alternative<RegionClicked>(gesture) ||
         std::holds_alternative<TakeBackClicked>(gesture) || std::holds_alternative<OutlineDone>(gesture) ||
         std::holds_alternative<HandleTaken>(gesture);
}

std::optional<Pixel> picks_at(const Gesture& gesture) {
  if (const auto* click = std::get_if<NodeClicked>(&gesture)) return click->at;
  if (const auto* click = std::get_if<RegionClicked>(&gesture)) return click->at;
  const auto* outline = std::get_if<OutlineDone>(&gesture);
  return outline != nullptr && !outline->way.empty() ? std::optional(outline->way.front()) : std::nullopt;
}

SelectMode Gestures::mode() const {
  if (layout_.takes_modifiers(button_, modifiers_)) return SelectMode::set;
  if (modifiers_.ctrl) return modifiers_.shift ? SelectMode::intersect : SelectMode::subtract;
  return modifiers_.shift ? SelectMode::add : SelectMode::set;
}

std::vector<Gesture> Gestures::moved(const display::PointerMoved& event) {
  const Pixel at(event.x, event.y);
  position_ = at;
  if (navigation_) return navigated(at);
  if (drag_ == Drag::pressed && distance(at, down_) > kClickRadius) {
    std::vector<Gesture> begun = begin_drag(at);
    if (drag_ != Drag::outline || event.passed.empty()) return begun;
    way_ = {down_};
    for (const auto& [x, y] : event.passed) lengthen({x, y});
    lengthen(at);
    return {OutlineDrawn{way_, outline_ == DragDoes::other_outline}};
  }
  if (drag_ == Drag::handle) return {HandleMoved{at}};
  if (drag_ != Drag::outline) return {};
  for (const auto& [x, y] : event.passed) lengthen({x, y});
  lengthen(at);
  return {OutlineDrawn{way_, outline_ == DragDoes::other_outline}};
}

std::vector<Gesture> Gestures::navigated(const Pixel& at) {
  const Pixel by = at - navigation_->last;
  navigation_->last = at;
  switch (navigation_->does) {
    case DragDoes::pan: return {Panned{by.x(), by.y(), navigation_->from, at}};
    case DragDoes::zoom: return {Zoomed{navigation_->from, -by.y() / kPixelsPerZoomStep}};
    default: return {Orbited{by.x(), by.y(), navigation_->from, at}};
  }
}

void Gestures::lengthen(const Pixel& at) {
  if (way_.size() < 2)
    way_.push_back(at);
  else
    way_.back() = at;  // its end follows the pointer; a point stays where it is far enough from the one before
  if (distance(way_[way_.size() - 2], at) >= kOutlineStep && way_.size() < kMaxOutlinePoints) way_.push_back(at);
}

std::vector<Gesture> Gestures::begin_drag(const Pixel& at) {
  last_click_.reset();
  if (handle_below_) {
    drag_ = Drag::handle;
    return {HandleTaken{*handle_below_, down_}, HandleMoved{at}};
  }
  const DragDoes does = layout_.drag(button_, modifiers_);
  if (moves_view(does)) {
    drag_ = Drag::view;
    navigation_ = Navigation{button_, does, down_, down_};
    return navigated(at);
  }
  drag_ = Drag::outline;
  outline_ = does;
  way_ = {down_};
  lengthen(at);
  return {OutlineDrawn{way_, outline_ == DragDoes::other_outline}};
}

std::vector<Gesture> Gestures::button(const display::ButtonChanged& event, Under under) {
  position_ = Pixel(event.x, event.y);
  if (event.down) return drag_ == Drag::none ? pressed(event, under) : second_pressed(event, under);
  if (navigation_ && drag_ != Drag::view && event.button == navigation_->button) {
    navigation_.reset();
    return {};
  }
  return event.button == button_ ? released(event) : std::vector<Gesture>{};
}

/// While something is drawn or pulled, another button moves the view and nothing else.
std::vector<Gesture> Gestures::second_pressed(const display::ButtonChanged& event, Under under) {
  const bool waits = drag_ == Drag::outline || drag_ == Drag::handle;
  if (!waits || navigation_ || event.button == button_ || under == Under::panel) return {};
  const Pixel at(event.x, event.y);
  if (const DragDoes does = layout_.drag(event.button, event.modifiers); moves_view(does))
    navigation_ = Navigation{event.button, does, at, at};
  return {};
}

std::vector<Gesture> Gestures::pressed(const display::ButtonChanged& event, Under under) {
  button_ = event.button;
  modifiers_ = event.modifiers;
  down_ = Pixel(event.x, event.y);
  navigation_.reset();
  handle_below_.reset();
  if (under == Under::panel) {
    drag_ = Drag::panel;
    return {};
  }
  drag_ = Drag::pressed;
  const bool plain_left = event.button == MouseButton::left && !event.modifiers.alt;
  if (under == Under::picture || !plain_left) return {};
  if (under == Under::slide_handle || under == Under::falloff_ring) {
    // Disk and falloff line lie over nodes that may be meant: only a drag takes them, and only one that doesn't select.
    if (!event.modifiers.shift && !event.modifiers.ctrl) handle_below_ = under;
    return {};
  }
  if (second_click(event.time_ms)) {
    // The first click has put the handle under the pointer, perhaps before the second one came.
    handle_below_ = under;
    return {};
  }
  drag_ = Drag::handle;
  return {HandleTaken{under, down_}};
}

bool Gestures::second_click(std::int64_t time_ms) const {
  return last_click_ && distance(*last_click_, down_) <= kClickRadius && time_ms - last_click_ms_ <= kDoubleClickMs;
}

std::vector<Gesture> Gestures::released(const display::ButtonChanged& event) {
  const Drag was = drag_;
  drag_ = Drag::none;
  navigation_.reset();
  const Pixel at(event.x, event.y);
  switch (was) {
    case Drag::pressed: return clicked(event);
    case Drag::outline:
      lengthen(at);
      return {OutlineDone{std::exchange(way_, {}), outline_ == DragDoes::other_outline,
                          outline_ == DragDoes::remove_outline ? SelectMode::subtract : mode()}};
    case Drag::handle: return {HandleReleased{at}};
    default: return {};
  }
}

std::vector<Gesture> Gestures::clicked(const display::ButtonChanged& event) {
  if (modifiers_.alt) return {};
  if (second_click(event.time_ms) && layout_.double_click(event.button, modifiers_) == ClickDoes::region) {
    const Pixel first = *last_click_;
    last_click_.reset();
    return {RegionClicked{first, mode()}};
  }
  last_click_.reset();
  switch (layout_.click(event.button, modifiers_)) {
    case ClickDoes::take_back: return {TakeBackClicked{}};
    case ClickDoes::unpick: return {NodeClicked{down_, SelectMode::subtract, true}};
    case ClickDoes::region: return {RegionClicked{down_, mode()}};
    case ClickDoes::pick:
      last_click_ = down_;
      last_click_ms_ = event.time_ms;
      return {NodeClicked{down_, mode()}};
    case ClickDoes::nothing: break;
  }
  return {};
}

std::vector<Gesture> Gestures::wheel(const display::WheelTurned& event, Under under) {
  position_ = Pixel(event.x, event.y);
  if (under == Under::panel) return {};
  if (layout_.wheel(event.modifiers) == WheelDoes::angle) return {AngleTurned{event.steps}};
  return {Zoomed{Pixel(event.x, event.y), event.steps}};
}

bool Gestures::cancel() {
  const bool something = drag_ == Drag::outline || drag_ == Drag::handle;
  if (drag_ != Drag::none) drag_ = Drag::dead;
  navigation_.reset();
  last_click_.reset();
  way_.clear();
  return something;
}

}  // namespace prismesh::kiosk::input
