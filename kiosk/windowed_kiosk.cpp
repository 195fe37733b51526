#include "kiosk/windowed_kiosk.h"

#include <poll.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kiosk/display/monitor.h"
#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/tool_list.h"
#include "kiosk/tools/files/files_tool.h"

namespace prismesh::kiosk {

namespace {

constexpr std::int64_t kCaretBlinkNs = 300'000'000;  ///< the caret of a text field blinks without any event
constexpr std::int64_t kWheelRestNs = 250'000'000;   ///< the wheel counts as still this long after its last step
constexpr std::int64_t kPointerRestNs = 60'000'000;  ///< the pointer rests this long after its last move
constexpr std::int64_t kWordNs = 220'000'000;        ///< letters of a word come faster than that
constexpr std::int64_t kPieceNs = 50'000'000;        ///< of a picture at rest, between two looks at the input
constexpr std::int64_t kLongTurnNs = 30'000'000;
constexpr std::int64_t kForEverNs = -1;
constexpr std::int64_t kDaemonTriesNs = 1'000'000'000;  ///< between two attempts to reach a missing device daemon, or the pen's process
constexpr std::int64_t kPenLookNs = 8'000'000;          ///< between two looks at a pen, which moves without a message

char lower(display::Key letter) { return static_cast<char>(static_cast<int>(letter) - 'A' + 'a'); }

std::int64_t shorter(std::int64_t a, std::int64_t b) { return a < 0 ? b : b < 0 ? a : std::min(a, b); }

}  // namespace

WindowedKiosk::WindowedKiosk(display::Window& window, Station& station) : window_(window), station_(station), gestures_(station.mouse) {
  station_.screen.set_size(window.size());
  find_place();
}

Result<void> WindowedKiosk::run() {
  if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;  // so that the panels' width is known
  while (!station_.editor.context().quits) {
    looks();
    const Result<std::vector<display::WindowEvent>> events = window_.take_events();
    if (!events) return fail(events.error());
    for (const display::WindowEvent& event : *events) {
      if (Result<void> taken = take(event); !taken) return taken;
      const auto* button = std::get_if<display::ButtonChanged>(&event);
      presses_ += (button != nullptr && button->down) || std::holds_alternative<display::WheelTurned>(event) ? 1 : 0;
      releases_ += button != nullptr && !button->down ? 1 : 0;
    }
    rest_traced_ = rest_traced_ && events->empty();
    if (Result<void> turned = station_.turn(); !turned) return turned;
    if (const auto& model = station_.link.document.snapshot()) watch_.draws(model->shell_count());
    point();
    station_.editor.hover(gestures_.dragging() ? gestures_.position() : pointer_on_picture(),
                          gestures_.dragging() || station_.screen.gui().popup_open());
    if (held_ && station_.clock.now_ns() >= held_->fires_ns)
      if (Result<void> fired = fire_held(); !fired) return fired;
    const Result<bool> drawn = beat();
    if (!drawn) return fail(drawn.error());
    if (*drawn) watch_.shown();
    watch_.turn(station_.clock.now_ns(), stale());
    rest_traced_ = rest_traced_ && !*drawn;
    if (*drawn || piece_drawn_ || put_off_ || !events->empty()) continue;
    if (!stale() && !std::exchange(rest_traced_, true)) trace_rest();
    wait();
    looked_ns_ = station_.clock.now_ns();
  }
  return {};
}

/// Keeps the longest time in which the input wasn't looked at although something was done.
void WindowedKiosk::looks() {
  const std::int64_t now = station_.clock.now_ns();
  if (looked_ns_ != 0) longest_ns_ = std::max(longest_ns_, now - looked_ns_);
  looked_ns_ = now;
}

/// Looks at the eyes and draws, if it is time to and something has changed. Returns whether a picture was drawn.
Result<bool> WindowedKiosk::beat() {
  if (!stale() && !station_.eyes.watches()) return false;
  if (!piece_drawn_ && !put_off_ && station_.clock.now_ns() < station_.eyes.next_look_ns()) return false;
  const bool seen_otherwise = station_.look();
  if (!seen_otherwise && !stale()) return false;
  return draw();
}

/// A large model at rest is drawn in pieces, between which input is looked at; until the picture is whole, one that is drawn for speed
/// shows what has changed. Returns whether a picture was shown.
Result<bool> WindowedKiosk::draw() {
  const bool large = shows_large();
  const bool changed = dirty_ || station_.editor.changes() != shown_changes_;
  // A turn that took over a large model looks at the input before it draws.
  if (large && station_.clock.now_ns() - looked_ns_ > kLongTurnNs && !std::exchange(put_off_, true)) return false;
  put_off_ = false;
  auto pace = large && (moving() || gliding()) ? Screen::Pace::moving : Screen::Pace::rest;
  if (!large || pace == Screen::Pace::moving) {
    piece_drawn_ = false;
  } else if (changed && std::exchange(piece_drawn_, false)) {
    pace = Screen::Pace::waiting;
  } else {
    const Result<bool> whole = station_.screen.draw_piece(kPieceNs);
    if (!whole) return fail(whole.error());
    piece_drawn_ = !*whole;
    shown_moving_ = true;
    watch_.draws_piece();
    if (!*whole) return false;
    rests_ns_ = station_.clock.now_ns();  // what picking needs is drawn ahead
  }
  if (Result<void> drawn = show(pace); !drawn) return fail(drawn.error());
  return true;
}

namespace {

bool is_of_hand(const display::WindowEvent& event) {
  return std::holds_alternative<display::PointerMoved>(event) || std::holds_alternative<display::ButtonChanged>(event) ||
         std::holds_alternative<display::WheelTurned>(event) || std::holds_alternative<display::KeyChanged>(event) ||
         std::holds_alternative<display::TextTyped>(event);
}

/// What was pressed before must be let go, whoever takes the input.
bool is_release(const display::WindowEvent& event) {
  const auto* key = std::get_if<display::KeyChanged>(&event);
  const auto* button = std::get_if<display::ButtonChanged>(&event);
  return (key != nullptr && !key->down) || (button != nullptr && !button->down);
}

}  // namespace

/// Neither the repetition of a key that is held down, nor its text, nor the trembling of a mouse.
bool WindowedKiosk::is_fresh(const display::WindowEvent& event) {
  constexpr double kTremblesPixels = 5;
  if (std::holds_alternative<display::TextTyped>(event)) return false;
  if (const auto* key = std::get_if<display::KeyChanged>(&event)) return !key->repeat;
  const auto* moved = std::get_if<display::PointerMoved>(&event);
  if (moved == nullptr) return true;
  const input::Pixel at(moved->x, moved->y);
  if (moved_from_ && (at - *moved_from_).norm() < kTremblesPixels) return false;
  return std::exchange(moved_from_, at).has_value();
}

Result<void> WindowedKiosk::take(const display::WindowEvent& event) {
  // What is done in another window isn't for this one.
  const bool lost = std::holds_alternative<display::FocusLost>(event);
  const bool gained =
      std::holds_alternative<display::FocusGained>(event) || (is_of_hand(event) && !std::holds_alternative<display::PointerMoved>(event));
  if (station_.space_mice && (lost || gained)) station_.space_mice->listen(gained);
  if (is_of_hand(event) && !is_release(event) && station_.editor.takes_input(is_fresh(event))) {
    dirty_ = true;
    return {};
  }
  if (const auto* moved = std::get_if<display::PointerMoved>(&event)) {
    // What was pressed is known before the pointer has left it.
    if (Result<void> settled = settle(); !settled) return settled;
    const bool was_on_panel = gestures_.position() && station_.screen.gui().on_panel(gestures_.position()->x(), gestures_.position()->y());
    station_.screen.gui().feed(event);
    edge_fed_ = station_.screen.gui().holds_pointer();  // the way up to the release counts
    gestures(gestures_.moved(*moved));
    station_.editor.pointer_moved({moved->x, moved->y});
    // Panels answer to the pointer, and some pictures carry it.
    if (was_on_panel || station_.screen.gui().on_panel(moved->x, moved->y) || draws_pointer()) dirty_ = true;
    rests_ns_ = station_.clock.now_ns() + kPointerRestNs;
    return {};
  }
  if (const auto* button = std::get_if<display::ButtonChanged>(&event)) return take_button(*button);
  if (const auto* key = std::get_if<display::KeyChanged>(&event)) return take_key(*key);
  if (const auto* text = std::get_if<display::TextTyped>(&event)) return take_text(*text);
  station_.screen.gui().feed(event);
  dirty_ = true;
  if (const auto* wheel = std::get_if<display::WheelTurned>(&event)) {
    const bool panel = station_.screen.gui().on_panel(wheel->x, wheel->y);
    gestures(gestures_.wheel(*wheel, panel ? input::Under::panel : input::Under::picture));
    if (!panel) wheel_rest_ns_ = station_.clock.now_ns() + kWheelRestNs;
  } else if (const auto* resized = std::get_if<display::Resized>(&event)) {
    station_.screen.set_size(resized->size);
    find_place();
  } else if (std::holds_alternative<display::Moved>(event)) {
    find_place();
  } else if (std::holds_alternative<display::PointerLeft>(event)) {
    gestures_.left();
  } else if (std::holds_alternative<display::FocusLost>(event)) {
    gestures_.cancel();
    station_.editor.cancel_gesture();
  } else if (std::holds_alternative<display::CloseRequested>(event)) {
    station_.editor.command(tools::files::quit_command(), std::nullopt);
  }
  return {};
}

Result<void> WindowedKiosk::take_button(const display::ButtonChanged& event) {
  if (Result<void> fired = fire_held(); !fired) return fired;
  if (Result<void> settled = settle(); !settled) return settled;
  station_.screen.gui().feed(event);
  edge_fed_ = dirty_ = true;
  const bool panel = station_.screen.gui().on_panel(event.x, event.y);
  const input::Under under = panel ? input::Under::panel : station_.editor.under({event.x, event.y});
  gestures(gestures_.button(event, under));
  return {};
}

Result<void> WindowedKiosk::take_key(const display::KeyChanged& event) {
  if (Result<void> settled = settle(); !settled) return settled;
  const bool pastes = event.down && event.modifiers.ctrl && event.key == display::letter('V') && station_.screen.gui().wants_keys();
  if (const auto text = pastes ? window_.clipboard() : std::nullopt) station_.screen.gui().set_clipboard(*text);
  station_.screen.gui().feed(event);
  edge_fed_ = dirty_ = true;
  if (!event.down) return {};
  swallow_text_ = false;
  if (station_.editor.dialog_open() || station_.screen.gui().wants_keys()) word_.clear();  // it is the field's
  if (!event.repeat && !event.modifiers.ctrl && !event.modifiers.alt && station_.editor.reply_by_key(event.key)) {
    swallow_text_ = true;
    return {};
  }
  const bool digit = event.key >= display::Key::digit_0 && event.key <= display::Key::digit_9;
  if (digit && !event.modifiers.ctrl && !event.modifiers.alt && station_.editor.takes_numbers(pointer_on_picture())) return {};
  const input::KeyBinding* binding = input::binding_for(key_bindings(), event.key, event.modifiers);
  if (binding == nullptr || (event.repeat && !binding->repeats())) return {};
  const bool cancels =
      binding->command == command_of(EditorCommand::cancel) || binding->command == command_of(EditorCommand::stop_and_keep);
  // While a path is typed the keyboard is the text field's.
  if (station_.editor.dialog_open() ? !cancels : station_.screen.gui().wants_keys()) return {};
  const Result<bool> taken = take_letter(event, *binding);
  if (!taken) return fail(taken.error());
  if (*taken) return {};
  gestures_.forget_click();
  if (station_.screen.gui().popup_open()) {
    station_.screen.gui().close_popups();
    if (cancels) return {};
  }
  if (cancels) gestures_.cancel();
  do_command(binding->command);
  swallow_text_ = station_.editor.dialog_open();
  return give_field_the_keyboard();
}

/// A text field takes the keyboard two layouts after it appears; the next key may be in the queue already.
Result<void> WindowedKiosk::give_field_the_keyboard() {
  for (int round = 0; round < 3 && station_.editor.dialog_open() && !station_.screen.gui().wants_keys(); ++round)
    if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;
  return {};
}

Result<void> WindowedKiosk::take_text(const display::TextTyped& event) {
  if (std::exchange(swallow_text_, false)) return {};
  dirty_ = true;
  if (!station_.screen.gui().wants_keys() && input::begins_number(event.text) && station_.editor.takes_numbers(pointer_on_picture())) {
    station_.editor.begin_number(event.text, pointer_on_picture());
    return give_field_the_keyboard();
  }
  station_.screen.gui().feed(event);
  return {};
}

/// Plain letters: those that edit are held until it is known that no word is being typed, which goes to the search. One that follows two
/// letters at once ends or goes on with a word. True: nothing is left to do.
Result<bool> WindowedKiosk::take_letter(const display::KeyChanged& event, const input::KeyBinding& binding) {
  const bool letter = event.key >= display::letter('A') && event.key <= display::letter('Z');
  const bool plain = letter && !event.modifiers.ctrl && !event.modifiers.alt && !event.modifiers.shift;
  const std::int64_t now = station_.clock.now_ns();
  const bool follows = plain && !word_.empty() && word_.back() != lower(event.key) && now - last_letter_ns_ < kWordNs;
  if (!follows) word_.clear();
  last_letter_ns_ = now;
  const bool edits = binding.asks_for_edit() && !binding.opens_field();
  const bool word = follows && (held_ || (edits && word_.size() >= 2));  // two letters may be two keys
  if (plain && !word) word_ += lower(event.key);
  if (word) {
    held_.reset();
    station_.editor.find(std::exchange(word_, {}));  // this letter comes as text
    if (Result<void> given = give_field_the_keyboard(); !given) return fail(given.error());
    return true;
  }
  if (Result<void> fired = fire_held(); !fired) return fail(fired.error());
  if (!plain || event.repeat || !edits) return false;
  held_ = HeldLetter{&binding, pointer_on_picture(), now + kWordNs};
  return true;
}

Result<void> WindowedKiosk::fire_held() {
  const std::optional<HeldLetter> held = std::exchange(held_, std::nullopt);
  if (!held || station_.editor.dialog_open()) return {};  // a question that came meanwhile goes first
  gestures_.forget_click();
  do_command(held->binding->command, held->pointer);
  return {};
}

void WindowedKiosk::do_command(const input::Command& command) { do_command(command, pointer_on_picture()); }

void WindowedKiosk::do_command(const input::Command& command, const std::optional<input::Pixel>& pointer) {
  const bool of_window = command == command_of(EditorCommand::fullscreen) || command == command_of(EditorCommand::rearm);
  if (of_window && !station_.editor.allow_command(command)) return;
  if (command == command_of(EditorCommand::fullscreen))
    window_.set_fullscreen(fullscreen_ = !fullscreen_);
  else if (command == command_of(EditorCommand::rearm))
    station_.devices.rearm();
  else
    station_.editor.command(command, pointer);
}

std::optional<input::Pixel> WindowedKiosk::pointer_on_picture() const {
  const std::optional<input::Pixel> at = gestures_.position();
  return at && !station_.screen.gui().on_panel(at->x(), at->y()) ? at : std::nullopt;
}

/// The pointer has rested: what is under it is told.
void WindowedKiosk::point() {
  if (!rests_ns_ || moving() || station_.clock.now_ns() < *rests_ns_) return;
  if (shows_large()) {
    if (piece_drawn_) return;  // first the picture
    if (!station_.editor.prepare_picking(kPieceNs)) return;
  }
  rests_ns_.reset();
  if (station_.screen.gui().popup_open()) return;  // a menu may be about what was under it
  station_.editor.point_at(pointer_on_picture());
}

bool WindowedKiosk::shows_large() const {
  const auto& shown = station_.editor.context().shown.snapshot;
  return shown && shown->shell_count() > LevelsWorker::kFewestShells;
}

Result<void> WindowedKiosk::settle() {
  if (!std::exchange(edge_fed_, false)) return {};
  if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;
  offer_copied();
  return {};
}

void WindowedKiosk::offer_copied() {
  if (const std::optional<std::string> copied = station_.screen.gui().take_copied()) window_.set_clipboard(*copied);
}

Result<void> WindowedKiosk::show(Screen::Pace pace) {
  shown_changes_ = station_.editor.changes();
  dirty_ = edge_fed_ = false;
  window_.show_pointer(!station_.editor.profile().stereo());
  const std::int64_t begun_ns = station_.clock.now_ns();
  shown_moving_ = pace != Screen::Pace::rest;
  const std::optional<input::Pixel> pointer = draws_pointer() ? gestures_.position() : std::nullopt;
  if (Result<void> drawn = station_.screen.draw(0, pointer, pace); !drawn) return drawn;
  if (station_.eyes.watches()) window_.finish();
  offer_copied();
  station_.eyes.drawn(station_.eyes.watches() ? window_.last_refresh_ns() : std::nullopt);
  window_.present();
  // A picture may take longer than a wheel's steps lie apart.
  if (station_.clock.now_ns() < wheel_rest_ns_ + kWheelRestNs)
    wheel_rest_ns_ = std::max(wheel_rest_ns_, station_.clock.now_ns() + kWheelRestNs);
  const char* const paces[] = {"at rest", "moving", "waiting"};
  const double took_ms = static_cast<double>(station_.clock.now_ns() - begun_ns) * 1e-6;
  station_.trace.line(fmt::format("drawn {} in {:.1f} ms", paces[static_cast<std::size_t>(pace)], took_ms));
  if (const std::size_t scenes = station_.renderer->figures().scenes_drawn; scenes != std::exchange(traced_scenes_, scenes))
    station_.trace.line(fmt::format("scenes {}", scenes));
  trace_picture();
  return {};
}

void WindowedKiosk::trace_picture() {
  station_.editor.trace_picture();
  if (pictures_ == 0) station_.trace.line(fmt::format("ready {} {}", window_.size().width, window_.size().height));
  ++pictures_;
  const auto& shown = station_.editor.context().shown.snapshot;
  station_.trace.line(fmt::format("picture {} generation {}", pictures_, shown ? std::to_string(shown->info().generation) : "none"));
}

void WindowedKiosk::trace_rest() {
  const std::optional<input::Pixel> at = gestures_.position();
  const std::string where = at ? fmt::format("{} {}", at->x(), at->y()) : "none";
  station_.trace.line(fmt::format("looked within {:.0f} ms", static_cast<double>(std::exchange(longest_ns_, 0)) * 1e-6));
  station_.trace.line(fmt::format("rests presses {} releases {} pointer {}", presses_, releases_, where));
}

std::int64_t WindowedKiosk::patience_ns() const {
  const std::int64_t now = station_.clock.now_ns();
  const int link_ms = station_.link.patience_ms();
  std::int64_t patience = link_ms < 0 ? kForEverNs : link_ms * std::int64_t{1'000'000};
  if (!station_.devices.connected() || !station_.pen.is_connected()) patience = shorter(patience, kDaemonTriesNs);
  if (station_.pen.has_pen()) patience = shorter(patience, kPenLookNs);
  if (station_.space_mice) {
    // Its cap may be held still, and a move ends when it has rested.
    const bool works = !station_.space_mice->motion().at_rest() || station_.link.drag.running() != nullptr;
    patience = shorter(patience, works && station_.space_mice->any() ? kPenLookNs : drivers::space_mouse::SpaceMice::kLookNs);
  }
  if (stale() || station_.eyes.watches()) patience = shorter(patience, std::max<std::int64_t>(0, station_.eyes.next_look_ns() - now));
  if (station_.screen.gui().wants_keys()) patience = shorter(patience, kCaretBlinkNs);
  if (const auto report = watch_.next_ns()) patience = shorter(patience, std::max<std::int64_t>(0, *report - now));
  if (const auto levels = station_.editor.next_levels_ns()) patience = shorter(patience, std::max<std::int64_t>(0, *levels - now));
  if (const std::int64_t next = station_.editor.next_follow_ns(); next >= 0)
    patience = shorter(patience, std::max<std::int64_t>(0, next - now));
  if (held_) patience = shorter(patience, std::max<std::int64_t>(0, held_->fires_ns - now));
  if (rests_ns_ && !gestures_.dragging()) patience = shorter(patience, std::max<std::int64_t>(0, *rests_ns_ - now));
  if (shown_moving_ && !gestures_.dragging()) patience = shorter(patience, std::max<std::int64_t>(0, wheel_rest_ns_ - now));
  return patience;
}

void WindowedKiosk::wait() {
  std::vector<pollfd> watched{{window_.descriptor(), POLLIN, 0},
                              {station_.link.connection.descriptor(), POLLIN, 0},
                              {station_.devices.descriptor(), POLLIN, 0},
                              {station_.pen.descriptor(), POLLIN, 0}};
  if (station_.space_mice)
    for (const int descriptor : station_.space_mice->descriptors()) watched.push_back({descriptor, POLLIN, 0});
  const std::int64_t patience = patience_ns();
  const bool caret = station_.screen.gui().wants_keys();
  const timespec most{patience / 1'000'000'000, patience % 1'000'000'000};
  ::ppoll(watched.data(), watched.size(), patience < 0 ? nullptr : &most, nullptr);
  if (caret) dirty_ = true;
}

}  // namespace prismesh::kiosk
