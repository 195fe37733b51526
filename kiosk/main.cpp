// prismesh-kiosk: shows the model and edits it by mouse and keyboard.
#include <malloc.h>

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "kiosk/app.h"
#include "kiosk/render_command.h"

namespace {

using prismesh::kiosk::AppOptions;

bool parse_size(const std::string& text, prismesh::kiosk::display::PixelSize& size) {
  const char* const end = text.data() + text.size();
  const auto [x, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error != std::errc() || x == end || *x != 'x') return false;
  const auto [rest, height_error] = std::from_chars(x + 1, end, size.height);
  return height_error == std::errc() && rest == end && size.width >= 320 && size.height >= 240 && size.width <= 16384 &&
         size.height <= 16384;
}

bool parse_point(const std::string& text, prismesh::mesh::Vec3& point) {
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    const auto [next, error] = std::from_chars(at, end, point[i]);
    if (error != std::errc() || (i < 2 ? next == end || *next != ',' : next != end)) return false;
    at = next + 1;
  }
  return true;
}

int run_interactive(int argc, char** argv) {
  AppOptions options;
  std::string size = "1600x900", eye, profile, config, runtime_dir, deck, shots, screen;
  bool window = false;
  CLI::App app("The picture of a Prismesh station: shows the model server's document and edits it by hand.");
  app.add_option("--runtime-dir", runtime_dir, "Folder of the daemons' sockets")->option_text("DIR");
  app.add_option("--config", config, "Settings that go before those of the system and the user (docs/settings.md)")->option_text("FILE");
  auto* in_window = app.add_flag("--window", window, "Open in a window (the default)");
  app.add_flag("--fullscreen", options.fullscreen, "Cover the display")->excludes(in_window);
  app.add_option("--screen", screen, "What to show the picture on: x11, bare (no display server), usual (the settings', else usual)")
      ->option_text("usual|x11|bare")
      ->check(CLI::IsMember({"usual", "x11", "bare"}));
  app.add_option("--size", size, "Size of the window or the pictures (1600x900)")->option_text("WxH");
  app.add_option("--profile", profile, "Display profile: a name or a file (the settings', else mono)")->option_text("NAME|FILE");
  app.add_option("--eye", eye, "Fixed point between the eyes, mm from the screen's centre; no tracker is followed")->option_text("X,Y,Z");
  app.add_option("--open", deck, "Deck to open")->option_text("DECK");
  auto* frames = app.add_option("--headless-frames", options.headless_frames, "Draw so many pictures without a display, then end")
                     ->option_text("N")
                     ->check(CLI::Range(1, 1000000));
  auto* pace = app.add_option("--pace", options.pace_seconds, "Seconds between those pictures (0)")
                   ->option_text("S")
                   ->check(CLI::Range(0.0, 3600.0));
  pace->needs(frames);
  auto* folder = app.add_option("--shots", shots, "Folder for those pictures")->option_text("DIR");
  frames->needs(folder);
  folder->needs(frames);
  app.add_option("--title", options.title, "A line at the top of the view that says what is shown")->option_text("TEXT");
  app.add_flag("--calibrate", options.calibrate, "Lead through the calibration of this display; covers it")->excludes(frames);
  app.add_flag("--follow", options.follow, "Move together with other kiosks of this model server that follow");
  app.add_flag("--trace", options.trace, "Say what happens on standard output, a line each (docs/kiosk.md)");
  app.set_version_flag("--version", PRISMESH_VERSION);
  app.footer("`prismesh-kiosk --render` draws one picture of a snapshot; `prismesh render` calls it.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!parse_size(size, options.size)) {
    std::fprintf(stderr, "--size %s: write width and height in pixels, for example 1600x900 (320x240 to 16384x16384)\n", size.c_str());
    return 2;
  }
  if (prismesh::mesh::Vec3 fixed; !eye.empty() && parse_point(eye, fixed) && fixed.z() > 0) {
    options.fixed_eyes_mm = fixed;
  } else if (!eye.empty()) {
    std::fprintf(stderr, "--eye %s: write three numbers in mm, the last greater than 0, for example 0,0,650\n", eye.c_str());
    return 2;
  }
  if (!runtime_dir.empty()) options.runtime_dir = runtime_dir;
  if (!config.empty()) options.config = config;
  using prismesh::drivers::settings::ScreenKind;
  if (!screen.empty()) options.screen = screen == "x11" ? ScreenKind::x11 : screen == "bare" ? ScreenKind::bare : ScreenKind::usual;
  if (!profile.empty()) options.profile = profile;
  if (!deck.empty()) options.deck = std::filesystem::absolute(deck);
  options.shots = shots;
  if (options.calibrate && !window) options.fullscreen = true;
  return prismesh::kiosk::run_app(options);
}

}  // namespace

int main(int argc, char** argv) {
  ::mallopt(M_MMAP_THRESHOLD, 4 << 20);  // a large model's arrays go back to the system when they are freed
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--render") return prismesh::kiosk::render_main(std::vector<std::string>(argv + 1, argv + argc));
  return run_interactive(argc, argv);
}
