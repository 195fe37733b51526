// Everything of the kiosk but its display: the lines to the daemons, the picture and who looks at it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "kiosk/device_link.h"
#include "kiosk/display/monitor.h"
#include "kiosk/editor.h"
#include "kiosk/eye_watch.h"
#include "kiosk/model_link.h"
#include "kiosk/screen.h"

namespace prismesh::kiosk {

struct StationOptions {
  std::optional<std::filesystem::path> runtime_dir;  ///< where the daemons' sockets are
  std::optional<std::filesystem::path> deck;         ///< opened at the start
  stereo::Profile profile;
  tools::MouseLayout mouse = tools::default_mouse_layout();
  std::optional<mesh::Vec3> fixed_eyes_mm;  ///< the eyes are here, whatever a tracker says
  double panel_latency_ms = 10;
  bool trace = false;
  bool follows_others = false;  ///< moves together with other kiosks that do
};

/// Where the eyes are taken to be while nobody knows: between them, mm from the screen's centre.
inline const mesh::Vec3 kRestingEyesMm(0, 0, 650);

/// Needs a current GL context for all of its life.
struct Station {
  MonotonicClock clock;
  Trace trace;
  tools::MouseLayout mouse;
  ModelLink link;
  DeviceLink devices;
  EyeWatch eyes;
  std::unique_ptr<render::Renderer> renderer;
  Editor editor;
  Screen screen;

  static Result<std::unique_ptr<Station>> create(const StationOptions& options);

  /// Reads what the daemons say, and follows them.
  Result<void> turn();
  /// A beat of the display has come: looks where the eyes are. True: the picture must be drawn again.
  bool look();
  /// Where the picture lies: on which monitor, if that is known, and at which place of the desktop.
  void place(std::optional<display::Monitor> monitor, const display::Window::DesktopPosition& place);

 private:
  Station(const StationOptions& options, std::unique_ptr<render::Renderer> made, panels::Gui gui);
  void follow_profile();

  bool fixed_eyes_;
  mesh::Vec3 resting_mm_;
  double panel_latency_ms_;
  std::optional<display::Monitor> monitor_;
  display::Window::DesktopPosition place_;
  std::optional<stereo::Profile> followed_;  ///< the profile that eyes, place and link were last set up for
};

}  // namespace prismesh::kiosk
