#include "kiosk/app.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>

#include "base/supervisor.h"
#include "drivers/settings/settings.h"
#include "ipc/intake/client.h"
#include "ipc/setup/client.h"
#include "kiosk/calibrator.h"
#include "kiosk/display/headless.h"
#include "kiosk/headless_kiosk.h"
#include "kiosk/open_window.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/setup_screen.h"
#include "kiosk/station.h"
#include "kiosk/tools/exhibition/show_script.h"
#include "kiosk/windowed_kiosk.h"

namespace prismesh::kiosk {
namespace {

WindowOptions window_options(const AppOptions& options, const drivers::settings::DisplaySettings& settings) {
  WindowOptions window;
  window.screen = options.screen.value_or(settings.screen);
  window.title = "Prismesh";
  window.size = options.size;
  window.fullscreen = options.fullscreen;
  window.connector = settings.connector;
  window.mode = {settings.mode.width, settings.mode.height};
  window.refresh_hz = settings.mode.refresh_hz;
  window.may_switch_consoles = settings.console_switching;
  window.tell = [](const std::string& sentence) { std::fprintf(stderr, "%s\n", sentence.c_str()); };
  return window;
}

Result<std::optional<toolkit::ExhibitionOptions>> exhibition_of(const drivers::settings::ExhibitionSettings& settings) {
  if (settings.deck.empty()) return std::optional<toolkit::ExhibitionOptions>();
  toolkit::ExhibitionOptions exhibition;
  std::error_code none;
  if (!std::filesystem::is_regular_file(settings.deck, none))
    return fail(Error{settings.deck, 0, "the deck of the exhibition isn't there ([exhibition] deck in prismesh.toml)"});
  exhibition.deck = std::filesystem::absolute(settings.deck, none);
  exhibition.idle_ns = settings.idle_s * 1'000'000'000;
  exhibition.warning_ns = settings.warning_s * 1'000'000'000;
  exhibition.pin = settings.pin;
  if (settings.show.empty()) return exhibition;
  if (const auto show = tools::exhibition::read_show(settings.show); !show) return fail(show.error());
  std::ifstream in(settings.show, std::ios::binary);
  exhibition.show_file = settings.show;
  exhibition.show_text.assign(std::istreambuf_iterator<char>(in), {});
  return exhibition;
}

/// Calibrates the display that the window covers. Returns the profile's file, or nothing.
Result<std::optional<std::filesystem::path>> calibrate(const AppOptions& options, display::Window& window, Station& station,
                                                       const stereo::Profile& profile, std::int64_t idle_ns = -1) {
  Result<SaveTo> save_to = usual_place(options.config);
  if (!save_to) return fail(save_to.error());
  auto calibrator = Calibrator::create(window, station, profile, std::move(*save_to));
  if (!calibrator) return fail(calibrator.error());
  return (*calibrator)->run(idle_ns);
}

Result<void> run_calibration(const AppOptions& options, const WindowOptions& where, const StationOptions& what) {
  if (const Result<SaveTo> save_to = usual_place(options.config); !save_to) return fail(save_to.error());
  if (!what.profile.stereo())
    return fail("--calibrate",
                "the profile \"" + what.profile.name +
                    "\" shows no depth, so there is nothing to calibrate: name the kind of display, for example --profile prism-mask");
  MonotonicClock clock;
  Result<std::unique_ptr<display::Window>> window = open_window(where, clock);
  if (!window) return fail(window.error());
  Result<std::unique_ptr<Station>> station = Station::create(what);
  if (!station) return fail(station.error());
  (*station)->place((*window)->monitor(), (*window)->position());
  const Result<std::optional<std::filesystem::path>> saved = calibrate(options, **window, **station, what.profile);
  if (!saved) return fail(saved.error());
  if (*saved)
    std::printf("The calibration is saved in %s, and prismesh.toml names it.\n", (*saved)->c_str());
  else
    std::printf("Nothing was saved.\n");
  return {};
}

Result<void> run_headless(const AppOptions& options, const StationOptions& what) {
  const Result<display::Headless> context = display::Headless::create();
  if (!context) return fail(context.error());
  Result<std::unique_ptr<Station>> station = Station::create(what);
  if (!station) return fail(station.error());
  const Result<render::Offscreen> target = render::Offscreen::create(options.size.width, options.size.height);
  if (!target) return fail(target.error());
  return HeadlessKiosk(options, **station, *target).run();
}

/// What the settings say, as they are now.
struct Settled {
  StationOptions what;
  drivers::settings::DisplaySettings display;
  std::string profile;  ///< a name or a file
};

Result<Settled> settle(const AppOptions& options) {
  const Result<drivers::settings::StationSettings> settings = drivers::settings::read_settings(options.config);
  if (!settings) return fail(settings.error());
  Settled settled;
  settled.display = settings->display;
  // A machine that no settings say anything of has an ordinary screen.
  settled.profile = options.profile.value_or(settings->files.empty() ? "mono" : settings->display.profile);
  const Result<stereo::Profile> profile = stereo::find_profile(settled.profile);
  if (!profile) return fail(profile.error());
  Result<input::MouseLayout> mouse = input::find_mouse_layout(settings->hand.mouse);
  if (!mouse) return fail(mouse.error());
  StationOptions& what = settled.what;
  what.mouse = std::move(*mouse);
  what.runtime_dir = options.runtime_dir;
  what.deck = options.deck;
  what.profile = *profile;
  what.fixed_eyes_mm = options.fixed_eyes_mm;
  what.panel_latency_ms = settings->display.latency_ms;
  what.video_memory = static_cast<std::size_t>(settings->display.video_memory_mb) << 20;
  what.follows_others = options.follow;
  what.title = options.title;
  what.trace = options.trace;
  what.reads_space_mice = !options.calibrate && options.headless_frames == 0;
  if (options.calibrate) return settled;
  Result<std::optional<toolkit::ExhibitionOptions>> exhibition = exhibition_of(settings->exhibition);
  if (!exhibition) return fail(exhibition.error());
  what.exhibition = std::move(*exhibition);
  if (what.exhibition) what.deck.reset();  // it is opened as it lies on the disk, without edits of earlier visits
  return settled;
}

/// The station as it is set up; nothing: this machine isn't set up from the kiosk, or says nothing now.
std::optional<ipc::StationSetup> ask_for_setup(const AppOptions& options) {
  constexpr std::chrono::seconds kPatience{1};  // less than the watchdog's
  const std::filesystem::path socket = ipc::setup_socket_path(options.runtime_dir);
  std::error_code none;
  if (!std::filesystem::exists(socket, none)) return std::nullopt;
  Result<ipc::SetupAnswer> answer = ipc::ask_setup(socket, ipc::GetSetup{}, kPatience);
  if (!answer) std::fprintf(stderr, "the station's set-up: %s\n", answer.error().text().c_str());
  auto* station = answer ? std::get_if<ipc::StationSetup>(&*answer) : nullptr;
  return station != nullptr ? std::optional(std::move(*station)) : std::nullopt;
}

/// Leads through the set-up in the window.
Result<SetupScreen::End> run_setup(const AppOptions& options, display::Window& window, const Settled& settled,
                                   const ipc::StationSetup& station_setup) {
  constexpr std::int64_t kExhibitionIdleNs = 600'000'000'000;  ///< as an unlocked exhibition
  StationOptions what = settled.what;
  what.reads_space_mice = false;
  Result<std::unique_ptr<Station>> station = Station::create(what);
  if (!station) return fail(station.error());
  supervisor::tell_alive();  // before the shaders of another renderer
  (*station)->place(window.monitor(), window.position());
  SetupOptions setup;
  setup.socket = ipc::setup_socket_path(options.runtime_dir);
  setup.intake = ipc::intake_socket_path(options.runtime_dir);
  setup.station = station_setup;
  setup.profile = settled.profile;
  if (what.exhibition) setup.idle_ns = kExhibitionIdleNs;
  if (const auto usual = drivers::settings::usual_files(); usual.size() > 1) setup.own_settings = usual.back();
  setup.calibrate = [&](const stereo::Profile& profile, std::int64_t idle_ns) {
    return calibrate(options, window, **station, profile, idle_ns);
  };
  auto screen = SetupScreen::create(window, **station, std::move(setup));
  if (!screen) return fail(screen.error());
  return (*screen)->run();
}

Result<void> run_in_window(const AppOptions& options, Settled settled) {
  MonotonicClock clock;
  std::optional<ipc::StationSetup> setup = ask_for_setup(options);
  // Visitors don't set a station up; whoever knows the PIN can.
  if (setup && (!setup->due || settled.what.exhibition)) setup.reset();
  const WindowOptions where = window_options(options, settled.display);
  Result<std::unique_ptr<display::Window>> window = open_window(where, clock);
  if (!window) return fail(window.error());
  for (;;) {
    if (setup) {
      const Result<SetupScreen::End> end = run_setup(options, **window, settled, *setup);
      if (!end) return fail(end.error());
      if (*end == SetupScreen::End::closed) return {};
      Result<Settled> changed = settle(options);
      if (!changed) return fail(changed.error());
      settled = std::move(*changed);
      setup.reset();
      supervisor::tell_alive();
    }
    Result<std::unique_ptr<Station>> station = Station::create(settled.what);
    if (!station) return fail(station.error());
    if (Result<void> run = WindowedKiosk(**window, **station).run(); !run) return run;
    const toolkit::ToolContext& context = (*station)->editor.context();
    if (!context.anew) return {};
    supervisor::tell_alive();
    if (context.sets_up) setup = ask_for_setup(options);
    (*window)->set_clipboard({});
    (*window)->set_fullscreen(options.fullscreen);
  }
}

Result<void> run(const AppOptions& options) {
  Result<Settled> settled = settle(options);
  if (!settled) return fail(settled.error());
  if (options.headless_frames > 0) return run_headless(options, settled->what);
  if (options.calibrate) return run_calibration(options, window_options(options, settled->display), settled->what);
  return run_in_window(options, std::move(*settled));
}

}  // namespace

int run_app(const AppOptions& options) {
  const Result<void> done = run(options);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", done.error().text().c_str());
  supervisor::wait_before_failing();
  return 1;
}

}  // namespace prismesh::kiosk
