#include "kiosk/app.h"

#include <poll.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "kiosk/display/headless.h"
#include "kiosk/display/x11.h"
#include "kiosk/editor.h"
#include "kiosk/model_link.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/render/picture_file.h"
#include "kiosk/screen.h"
#include "kiosk/tools/gestures.h"

namespace prismesh::kiosk {
namespace {

constexpr int kCaretBlinkMs = 300;                  ///< a text field's caret is the only thing that moves by itself
constexpr std::int64_t kWheelRestNs = 250'000'000;  ///< so long after its last step a wheel is taken to stand still

/// Everything but the display. Needs a current GL context for all of its life.
struct Station {
  MonotonicClock clock;
  Trace trace;
  ModelLink link;
  std::unique_ptr<render::Renderer> renderer;
  Editor editor;
  Screen screen;

  Station(const AppOptions& options, const stereo::Profile& profile, std::unique_ptr<render::Renderer> made, panels::Gui gui)
      : trace(options.trace ? stdout : nullptr),
        link(ipc::model_socket_path(options.runtime_dir), options.deck, clock, trace),
        renderer(std::move(made)),
        editor({profile, options.between_eyes_mm}, link, *renderer, trace),
        screen(std::move(gui), *renderer, editor, clock) {}

  Result<void> turn() {
    link.turn();
    return editor.follow();
  }
};

Result<std::unique_ptr<Station>> make_station(const AppOptions& options, const stereo::Profile& profile) {
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create({});
  if (!renderer) return fail(renderer.error());
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return fail(gui.error());
  return std::make_unique<Station>(options, profile, std::move(*renderer), std::move(*gui));
}

/// The loop of a kiosk in a window.
class WindowedKiosk {
 public:
  WindowedKiosk(display::Window& window, Station& station) : window_(window), station_(station) { station_.screen.set_size(window.size()); }

  Result<void> run();

 private:
  Result<void> take(const display::WindowEvent& event);
  Result<void> take_button(const display::ButtonChanged& event);
  Result<void> take_key(const display::KeyChanged& event);
  void do_command(tools::Command command);
  Result<void> settle();
  /// The view or something in it is about to change again.
  bool moving() const { return gestures_.dragging() || station_.clock.now_ns() < wheel_rest_ns_; }
  Result<void> show();
  void wait();
  std::optional<tools::Pixel> pointer_on_picture() const;
  void gestures(const std::vector<tools::Gesture>& made) {
    for (const tools::Gesture& gesture : made) station_.editor.gesture(gesture);
  }

  display::Window& window_;
  Station& station_;
  tools::Gestures gestures_;
  bool edge_fed_ = false;  ///< a press or release that the panels haven't seen yet
  bool dirty_ = true;
  bool fullscreen_ = false;
  bool closing_ = false;
  bool shown_moving_ = false;  ///< the last picture was drawn for speed
  std::int64_t wheel_rest_ns_ = 0;
  std::uint64_t shown_changes_ = 0;
  std::uint64_t pictures_ = 0;
};

Result<void> WindowedKiosk::run() {
  if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;  // so that the panels' width is known
  while (!closing_) {
    const Result<std::vector<display::WindowEvent>> events = window_.take_events();
    if (!events) return fail(events.error());
    for (const display::WindowEvent& event : *events)
      if (Result<void> taken = take(event); !taken) return taken;
    if (Result<void> turned = station_.turn(); !turned) return turned;
    if (dirty_ || station_.editor.changes() != shown_changes_ || (shown_moving_ && !moving())) {
      if (Result<void> shown = show(); !shown) return shown;
    } else if (events->empty()) {
      wait();
    }
  }
  return {};
}

Result<void> WindowedKiosk::take(const display::WindowEvent& event) {
  if (const auto* moved = std::get_if<display::PointerMoved>(&event)) {
    const bool was_on_panel = gestures_.position() && station_.screen.gui().on_panel(gestures_.position()->x(), gestures_.position()->y());
    station_.screen.gui().feed(event);
    gestures(gestures_.moved(*moved));
    // Panels answer to the pointer, and a stereo picture carries it.
    if (was_on_panel || station_.screen.gui().on_panel(moved->x, moved->y) || station_.editor.profile().stereo()) dirty_ = true;
    return {};
  }
  if (const auto* button = std::get_if<display::ButtonChanged>(&event)) return take_button(*button);
  if (const auto* key = std::get_if<display::KeyChanged>(&event)) return take_key(*key);
  station_.screen.gui().feed(event);
  dirty_ = true;
  if (const auto* wheel = std::get_if<display::WheelTurned>(&event)) {
    const bool panel = station_.screen.gui().on_panel(wheel->x, wheel->y);
    gestures(gestures_.wheel(*wheel, panel ? tools::Under::panel : tools::Under::picture));
    if (!panel) wheel_rest_ns_ = station_.clock.now_ns() + kWheelRestNs;
  } else if (const auto* resized = std::get_if<display::Resized>(&event)) {
    station_.screen.set_size(resized->size);
  } else if (std::holds_alternative<display::PointerLeft>(event)) {
    gestures_.left();
  } else if (std::holds_alternative<display::FocusLost>(event)) {
    gestures_.cancel();
    station_.editor.cancel_gesture();
  } else if (std::holds_alternative<display::CloseRequested>(event)) {
    closing_ = true;
  }
  return {};
}

Result<void> WindowedKiosk::take_button(const display::ButtonChanged& event) {
  if (Result<void> settled = settle(); !settled) return settled;
  station_.screen.gui().feed(event);
  edge_fed_ = dirty_ = true;
  const bool panel = station_.screen.gui().on_panel(event.x, event.y);
  const tools::Under under = panel ? tools::Under::panel : station_.editor.under({event.x, event.y});
  gestures(gestures_.button(event, under));
  return {};
}

Result<void> WindowedKiosk::take_key(const display::KeyChanged& event) {
  if (Result<void> settled = settle(); !settled) return settled;
  station_.screen.gui().feed(event);
  edge_fed_ = dirty_ = true;
  if (!event.down) return {};
  const std::optional<tools::Command> command = tools::command_for(event.key, event.modifiers);
  if (!command || (event.repeat && !tools::repeats(*command))) return {};
  // While a path is typed the keyboard is the text field's.
  if (station_.editor.dialog_open() && *command != tools::Command::cancel) return {};
  gestures_.forget_click();
  if (*command == tools::Command::cancel) gestures_.cancel();
  do_command(*command);
  // A text field takes the keyboard two layouts after it appears; the next key may be in the queue already.
  for (int round = 0; round < 3 && station_.editor.dialog_open() && !station_.screen.gui().wants_keys(); ++round)
    if (Result<void> laid_out = station_.screen.lay_out(); !laid_out) return laid_out;
  return {};
}

void WindowedKiosk::do_command(tools::Command command) {
  if (command == tools::Command::fullscreen)
    window_.set_fullscreen(fullscreen_ = !fullscreen_);
  else
    station_.editor.command(command, pointer_on_picture());
}

std::optional<tools::Pixel> WindowedKiosk::pointer_on_picture() const {
  const std::optional<tools::Pixel> at = gestures_.position();
  return at && !station_.screen.gui().on_panel(at->x(), at->y()) ? at : std::nullopt;
}

Result<void> WindowedKiosk::settle() {
  if (!std::exchange(edge_fed_, false)) return {};
  return station_.screen.lay_out();
}

Result<void> WindowedKiosk::show() {
  shown_changes_ = station_.editor.changes();
  dirty_ = edge_fed_ = false;
  window_.show_pointer(!station_.editor.profile().stereo());
  shown_moving_ = moving() && station_.editor.large_model();
  if (Result<void> drawn = station_.screen.draw(0, gestures_.position(), shown_moving_); !drawn) return drawn;
  window_.present();
  // A picture may take longer than a wheel's steps lie apart.
  if (station_.clock.now_ns() < wheel_rest_ns_ + kWheelRestNs)
    wheel_rest_ns_ = std::max(wheel_rest_ns_, station_.clock.now_ns() + kWheelRestNs);
  station_.editor.trace_picture();
  if (pictures_ == 0) station_.trace.line(fmt::format("ready {} {}", window_.size().width, window_.size().height));
  ++pictures_;
  const std::optional<std::uint64_t> generation = station_.editor.shown_generation();
  station_.trace.line(fmt::format("picture {} generation {}", pictures_, generation ? std::to_string(*generation) : "none"));
  return {};
}

void WindowedKiosk::wait() {
  std::array<pollfd, 2> watched{{{window_.descriptor(), POLLIN, 0}, {station_.link.descriptor(), POLLIN, 0}}};
  int patience = station_.link.patience_ms();
  if (station_.screen.gui().wants_keys()) {
    patience = patience < 0 ? kCaretBlinkMs : std::min(patience, kCaretBlinkMs);
    dirty_ = true;
  }
  if (shown_moving_ && !gestures_.dragging()) {
    const std::int64_t left_ms = std::max<std::int64_t>(0, wheel_rest_ns_ - station_.clock.now_ns()) / 1'000'000 + 1;
    patience = patience < 0 ? static_cast<int>(left_ms) : std::min(patience, static_cast<int>(left_ms));
  }
  ::poll(watched.data(), watched.size(), patience);
}

Result<void> run_in_window(const AppOptions& options, const stereo::Profile& profile) {
  Result<std::unique_ptr<display::Window>> window = display::open_x11_window({"Prismesh", options.size, options.fullscreen});
  if (!window) return fail(window.error());
  Result<std::unique_ptr<Station>> station = make_station(options, profile);
  if (!station) return fail(station.error());
  return WindowedKiosk(**window, **station).run();
}

/// What was asked for can be seen, or nothing more is to be expected.
bool settled(const Station& station, const AppOptions& options) {
  if (!station.link.connected() || !station.link.state() || !station.link.busy().empty() || !station.link.up_to_date()) return false;
  return !(options.deck || station.link.state()->open) || station.link.snapshot() != nullptr;
}

Result<void> run_headless(const AppOptions& options, const stereo::Profile& profile) {
  using namespace std::chrono_literals;
  const Result<display::Headless> context = display::Headless::create();
  if (!context) return fail(context.error());
  Result<std::unique_ptr<Station>> made = make_station(options, profile);
  if (!made) return fail(made.error());
  Station& station = **made;
  const Result<render::Offscreen> target = render::Offscreen::create(options.size.width, options.size.height);
  if (!target) return fail(target.error());
  station.screen.set_size(options.size);
  if (Result<void> laid_out = station.screen.lay_out(); !laid_out) return laid_out;  // so that the panels' width is known
  std::error_code ignored;
  std::filesystem::create_directories(options.shots, ignored);

  const std::int64_t patience_ns = 10'000'000'000, started = station.clock.now_ns();
  for (int frame = 1; frame <= options.headless_frames;) {
    if (Result<void> turned = station.turn(); !turned) return turned;
    if (!settled(station, options) && station.clock.now_ns() - started < patience_ns) {
      std::this_thread::sleep_for(10ms);
      continue;
    }
    if (Result<void> drawn = station.screen.draw(target->framebuffer(), std::nullopt, false); !drawn) return drawn;
    const std::filesystem::path file = options.shots / fmt::format("frame-{:04}.png", frame++);
    if (Result<void> written = render::write_png(file, target->read()); !written) return written;
    station.trace.line("shot " + file.string());
  }
  return {};
}

}  // namespace

int run_app(const AppOptions& options) {
  const Result<stereo::Profile> profile = stereo::find_profile(options.profile);
  Result<void> done;
  if (!profile)
    done = fail(profile.error());
  else
    done = options.headless_frames > 0 ? run_headless(options, *profile) : run_in_window(options, *profile);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return 1;
}

}  // namespace prismesh::kiosk
