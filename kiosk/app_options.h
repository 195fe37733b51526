// The options that the kiosk starts with.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/settings/settings.h"
#include "kiosk/display/window.h"
#include "mesh/model/model.h"

namespace prismesh::kiosk {

struct AppOptions {
  std::optional<std::filesystem::path> runtime_dir;  ///< where the daemons' sockets are
  std::optional<std::filesystem::path> config;       ///< a settings file, read after the system's and the user's
  std::optional<std::filesystem::path> deck;         ///< opened at the start
  display::PixelSize size{1600, 900};
  bool fullscreen = false;
  std::optional<drivers::settings::ScreenKind> screen;  ///< empty: the settings'
  std::optional<std::string> profile;                   ///< a name or a profile file; empty: the settings', or else mono
  std::optional<mesh::Vec3> fixed_eyes_mm;              ///< between the eyes; goes before what a tracker says
  int headless_frames = 0;                              ///< > 0: no window; the program writes this number of pictures to `shots` and ends
  double pace_seconds = 0;                              ///< between those pictures
  std::filesystem::path shots;
  std::string title{};     ///< says at the top of the view what is shown
  bool calibrate = false;  ///< run the display's calibration instead
  bool follow = false;     ///< move together with other kiosks that follow
  bool trace = false;      ///< write a line for each event to standard output
};

}  // namespace prismesh::kiosk
