// What a panel is laid out into, and what the user asked for meanwhile.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kiosk/display/window.h"
#include "kiosk/input/command.h"
#include "kiosk/panels/places.h"

namespace prismesh::kiosk::panels {

/// What can be clicked or read on the screen, for programs that watch.
struct ScreenItem {
  std::string name;   ///< "rail Pull", "tab Parts"
  std::string state;  ///< "on", "off", a value
  Place place;
  bool operator==(const ScreenItem&) const = default;
};

struct PanelLayout {
  display::PixelSize picture;
  /// Carries out a command; called after the layout.
  std::function<void(const input::Command&)> run_command{};
  /// To be called in this order after the layout.
  std::vector<std::function<void()>> actions{};
  double top = 0;     ///< pixels: what lies over the picture stands below it
  double bottom = 0;  ///< pixels: what lies over the picture ends above it
  Places places{};
  std::vector<ScreenItem> items{};
  /// Carries out a command at a pixel of the picture; called after the layout.
  std::function<void(const input::Command&, double x, double y)> run_command_at{};

  /// What panels leave of the picture: what lies over the model keeps within it.
  Place view() const { return places.view.empty() ? whole(picture) : places.view; }

  void ask(std::function<void()> action) { actions.push_back(std::move(action)); }
  void ask(const input::Command& command) {
    actions.emplace_back([run = run_command, command] { run(command); });
  }
};

}  // namespace prismesh::kiosk::panels
