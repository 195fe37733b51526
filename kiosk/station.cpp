#include "kiosk/station.h"
#include "ipc/intake/client.h"

#include <cmath>
#include <utility>

#include "base/clock.h"
#include "ipc/setup/client.h"
#include "kiosk/display/link_check.h"
#include "kiosk/editor_keys.h"
#include "kiosk/toolkit/history_file.h"
#include "kiosk/tools/files/files_tool.h"
#include "kiosk/tools/view/view_keys.h"

namespace prismesh::kiosk {

namespace {

stereo::FollowOptions follow_options(const stereo::Profile& profile, bool fixed_eyes, const mesh::Vec3& resting_mm) {
  stereo::FollowOptions options;
  options.follow = profile.stereo() && !fixed_eyes;
  options.mono_without_eyes = profile.has_mask();
  options.movable_mask = profile.has_mask() && profile.mask_moves;
  options.resting_mm = resting_mm;
  options.eye_separation_mm = profile.eye_separation_mm;
  return options;
}

std::filesystem::path state_file(const char* name) {
  const std::filesystem::path folder = toolkit::kiosk_state_folder();
  return folder.empty() ? folder : folder / name;
}

/// What a visitor types in an exhibition is kept nowhere.
toolkit::ToolOptions tool_options(const StationOptions& options) {
  toolkit::ToolOptions tools;
  if (options.exhibition) {
    tools.exhibition = options.exhibition;
    tools.exhibition->tries = state_file("pin-tries");
    tools.exhibition->leave = tools::files::quit_command();
    tools.exhibition->fullscreen = command_of(EditorCommand::fullscreen);
    tools.exhibition->set_up = command_of(EditorCommand::set_up);
  } else {
    tools.expressions = state_file("expressions");
    tools.commands_used = state_file("commands");
    tools.decks_opened = state_file("decks");
    tools.intake = ipc::intake_socket_path(options.runtime_dir);
  }
  tools.setup = ipc::setup_socket_path(options.runtime_dir);
  tools.follows_others = options.follows_others;
  tools.title = options.title;
  tools.fit = ::prismesh::kiosk::tools::view::command_of(::prismesh::kiosk::tools::view::ViewCommand::fit);
  return tools;
}

}  // namespace

Station::Station(const StationOptions& options, std::unique_ptr<render::Renderer> made, panels::Gui gui)
    : trace(options.trace ? stdout : nullptr),
      mouse(options.mouse),
      link(ipc::model_socket_path(options.runtime_dir), options.deck, clock, trace),
      pen(ipc::pen_socket_path(options.runtime_dir), link.connection, clock, trace),
      devices(ipc::device_socket_path(options.runtime_dir), trace),
      space_mice(options.reads_space_mice ? std::make_unique<drivers::space_mouse::SpaceMice>(clock, drivers::space_mouse::system_sources())
                                          : nullptr),
      eyes({}, devices, clock, trace),
      renderer(std::move(made)),
      editor(options.profile, tool_options(options), {link, pen, *renderer, clock, trace, space_mice.get()}),
      screen(std::move(gui), options.mouse.in_words(),
             KeptArrangement(options.exhibition ? std::filesystem::path() : state_file("arrangement.toml")), editor),
      fixed_eyes_(options.fixed_eyes_mm.has_value()),
      resting_mm_(options.fixed_eyes_mm.value_or(kRestingEyesMm)),
      panel_latency_ms_(options.panel_latency_ms) {
  follow_profile();
  look();
}

Result<std::unique_ptr<Station>> Station::create(const StationOptions& options) {
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create({.video_memory = options.video_memory});
  if (!renderer) return fail(renderer.error());
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return fail(gui.error());
  return std::unique_ptr<Station>(new Station(options, std::move(*renderer), std::move(*gui)));
}

Result<void> Station::turn() {
  link.turn();
  pen.turn();
  devices.turn();
  if (space_mice) space_mice->turn();
  if (Result<void> followed = editor.follow(); !followed) return followed;
  if (Result<void> made = editor.make_levels(); !made) return made;
  follow_profile();
  return {};
}

bool Station::look() {
  const bool other = eyes.look();
  editor.look_from(eyes.seen());
  editor.set_eyes_facts(eyes.facts());
  return other;
}

void Station::place(std::optional<display::Monitor> monitor, const display::Window::DesktopPosition& place) {
  monitor_ = std::move(monitor);
  place_ = place;
  stereo::DisplayTiming timing;
  if (monitor_ && monitor_->refresh_hz > 1) timing.period_ns = std::llround(1e9 / monitor_->refresh_hz);
  timing.panel_latency_ns = nanoseconds(panel_latency_ms_);
  eyes.set_timing(timing);
  followed_.reset();
  follow_profile();
}

void Station::follow_profile() {
  if (followed_ == editor.profile()) return;
  followed_ = editor.profile();
  eyes.set_options(follow_options(*followed_, fixed_eyes_, resting_mm_));
  const display::LinkReport report = display::check_link(*followed_, monitor_);
  eyes.refuse_depth(report.stereo_allowed() ? std::string() : report.refusals.front());
  // Positions of followed eyes and of masks count from the panel's middle; without them the picture is its own screen.
  render::PanelPlace panel;
  if (monitor_ && (eyes.follows() || followed_->has_mask()))
    panel = {place_.x - monitor_->x, place_.y - monitor_->y, monitor_->shown.width, monitor_->shown.height};
  editor.set_panel(panel);
}

}  // namespace prismesh::kiosk
