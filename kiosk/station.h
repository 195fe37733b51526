// The parts of a kiosk without its display: connections to the daemons, editor, panels and eyes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "drivers/space_mouse/space_mice.h"
#include "kiosk/device_link.h"
#include "kiosk/display/monitor.h"
#include "kiosk/editor.h"
#include "kiosk/eye_watch.h"
#include "kiosk/input/mouse_layout.h"
#include "kiosk/link/model_link.h"
#include "kiosk/link/pen_link.h"
#include "kiosk/notices/trace.h"
#include "kiosk/screen.h"

namespace prismesh::kiosk {

struct StationOptions {
  std::optional<std::filesystem::path> runtime_dir;  ///< where the daemons' sockets are
  std::optional<std::filesystem::path> deck;         ///< opened at the start
  stereo::Profile profile;
  input::MouseLayout mouse = input::default_mouse_layout();
  std::optional<mesh::Vec3> fixed_eyes_mm;  ///< between the eyes; goes before what a tracker says
  double panel_latency_ms = 10;
  std::size_t video_memory = 0;  ///< bytes; 0: no limit
  bool trace = false;
  bool follows_others = false;  ///< moves together with other kiosks that do
  bool reads_space_mice = false;
  std::string title{};  ///< says at the top of the view what is shown
  std::optional<toolkit::ExhibitionOptions> exhibition{};
};

/// Between the eyes while nobody is tracked, mm from the screen's centre.
inline const mesh::Vec3 kRestingEyesMm(0, 0, 650);

/// Needs a current GL context for all of its life.
struct Station {
  MonotonicClock clock;
  notices::Trace trace;
  input::MouseLayout mouse;
  link::ModelLink link;
  link::PenLink pen;
  DeviceLink devices;
  std::unique_ptr<drivers::space_mouse::SpaceMice> space_mice;  ///< null: none are read
  EyeWatch eyes;
  std::unique_ptr<render::Renderer> renderer;
  Editor editor;
  Screen screen;

  static Result<std::unique_ptr<Station>> create(const StationOptions& options);

  /// Reads the daemons' messages, and follows them.
  Result<void> turn();
  /// Reads where the eyes are, once per refresh of the display. True: the picture must be drawn again.
  bool look();
  /// Sets where the picture lies: the monitor, if it is known, and the place on the desktop.
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
