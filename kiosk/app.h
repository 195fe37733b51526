// The kiosk as a program: a window (or pictures in a folder), the loop that waits for the hand and the model server, and drawing
// when something changed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kiosk/display/window.h"
#include "mesh/model/model.h"

namespace prismesh::kiosk {

struct AppOptions {
  std::optional<std::filesystem::path> runtime_dir;  ///< where the model server's socket is
  std::optional<std::filesystem::path> deck;         ///< opened at the start
  display::PixelSize size{1600, 900};
  bool fullscreen = false;
  std::string profile = "mono";  ///< a name or a profile file
  mesh::Vec3 between_eyes_mm = mesh::Vec3(0, 0, 650);
  int headless_frames = 0;  ///< > 0: no window; so many pictures are written to `shots`, then the program ends
  std::filesystem::path shots;
  bool trace = false;  ///< what happens goes to standard output, a line each
};

/// Runs until the window is closed or the pictures are written. Returns the exit status: 0 done, 1 it couldn't be done;
/// reasons go to standard error.
int run_app(const AppOptions& options);

}  // namespace prismesh::kiosk
