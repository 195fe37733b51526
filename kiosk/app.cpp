#include "kiosk/app.h"

#include <cstdio>
#include <memory>

#include "base/supervisor.h"
#include "drivers/settings/settings.h"
#include "kiosk/calibrator.h"
#include "kiosk/display/headless.h"
#include "kiosk/display/x11.h"
#include "kiosk/headless_kiosk.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/station.h"
#include "kiosk/windowed_kiosk.h"

namespace prismesh::kiosk {
namespace {

Result<void> run_in_window(const AppOptions& options, const StationOptions& what) {
  Result<std::unique_ptr<display::Window>> window = display::open_x11_window({"Prismesh", options.size, options.fullscreen});
  if (!window) return fail(window.error());
  Result<std::unique_ptr<Station>> station = Station::create(what);
  if (!station) return fail(station.error());
  return WindowedKiosk(**window, **station).run();
}

/// Calibrates the display that the window covers.
Result<void> run_calibration(const AppOptions& options, const StationOptions& what) {
  Result<SaveTo> save_to = usual_place(options.config);
  if (!save_to) return fail(save_to.error());
  if (!what.profile.stereo())
    return fail("--calibrate",
                "the profile \"" + what.profile.name +
                    "\" shows no depth, so there is nothing to calibrate: name the kind of display, for example --profile prism-mask");
  Result<std::unique_ptr<display::Window>> window = display::open_x11_window({"Prismesh", options.size, options.fullscreen});
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
  what.follows_others = options.follow;
  what.trace = options.trace;
  if (options.calibrate) return run_calibration(options, what);
  return options.headless_frames > 0 ? run_headless(options, what) : run_in_window(options, what);
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
