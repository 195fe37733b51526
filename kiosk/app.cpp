#include "kiosk/app.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>

#include "base/supervisor.h"
#include "drivers/settings/settings.h"
#include "kiosk/calibrator.h"
#include "kiosk/display/headless.h"
#include "kiosk/headless_kiosk.h"
#include "kiosk/open_window.h"
#include "kiosk/render/offscreen.h"
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

Result<void> run_in_window(const WindowOptions& options, const StationOptions& what) {
  MonotonicClock clock;
  Result<std::unique_ptr<display::Window>> window = open_window(options, clock);
  if (!window) return fail(window.error());
  for (;;) {
    Result<std::unique_ptr<Station>> station = Station::create(what);
    if (!station) return fail(station.error());
    if (Result<void> run = WindowedKiosk(**window, **station).run(); !run) return run;
    if (!(*station)->editor.context().anew) return {};
    (*window)->set_clipboard({});
    (*window)->set_fullscreen(options.fullscreen);
  }
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

/// Calibrates the display that the window covers.
Result<void> run_calibration(const AppOptions& options, const WindowOptions& where, const StationOptions& what) {
  Result<SaveTo> save_to = usual_place(options.config);
  if (!save_to) return fail(save_to.error());
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
  auto calibrator = Calibrator::create(**window, **station, what.profile, std::move(*save_to));
  if (!calibrator) return fail(calibrator.error());
  const Result<std::optional<std::filesystem::path>> saved = (*calibrator)->run();
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

Result<void> run(const AppOptions& options) {
  const Result<drivers::settings::StationSettings> settings = drivers::settings::read_settings(options.config);
  if (!settings) return fail(settings.error());
  // A machine that no settings say anything of has an ordinary screen.
  const std::string profile_name = options.profile.value_or(settings->files.empty() ? "mono" : settings->display.profile);
  const Result<stereo::Profile> profile = stereo::find_profile(profile_name);
  if (!profile) return fail(profile.error());
  Result<input::MouseLayout> mouse = input::find_mouse_layout(settings->hand.mouse);
  if (!mouse) return fail(mouse.error());
  StationOptions what;
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
  if (!options.calibrate) {
    Result<std::optional<toolkit::ExhibitionOptions>> exhibition = exhibition_of(settings->exhibition);
    if (!exhibition) return fail(exhibition.error());
    what.exhibition = std::move(*exhibition);
    if (what.exhibition) what.deck.reset();  // it is opened as it lies on the disk, without edits of earlier visits
  }
  if (options.headless_frames > 0) return run_headless(options, what);
  what.reads_space_mice = !options.calibrate;
  const WindowOptions window = window_options(options, settings->display);
  return options.calibrate ? run_calibration(options, window, what) : run_in_window(window, what);
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
