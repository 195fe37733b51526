// Routes gestures, keys and the words of the model server to the tools, and asks them for their parts of the picture.
// Knows the renderer (for what lies under the pointer) but no window.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/clock.h"
#include "kiosk/display/window.h"
#include "kiosk/levels_worker.h"
#include "kiosk/link/model_link.h"
#include "kiosk/notices/notices.h"
#include "kiosk/notices/trace.h"
#include "kiosk/render/renderer.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk {

/// The services that the editor works with.
struct EditorServices {
  link::ModelLink& link;
  link::PenLink& pen;
  render::Renderer& renderer;
  Clock& clock;
  notices::Trace trace;
  drivers::space_mouse::SpaceMice* space_mice = nullptr;  ///< null: none are read here
};

class Editor {
 public:
  Editor(const stereo::Profile& profile, const toolkit::ToolOptions& options, const EditorServices& services);
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  void set_picture_size(display::PixelSize size);
  /// What panels leave of the picture: the view's middle follows.
  void set_room(const render::PixelRect& room);
  /// Where the pointer rests; none: beside the model. Finds what is under it.
  void point_at(const toolkit::Pointer& pointer);
  /// Where the pointer is on the picture, in each turn of the loop. `follows`: it drags the view, or something else takes it. Where a
  /// handle is below it, or follows it, the panels change.
  void hover(const toolkit::Pointer& pointer, bool follows);
  /// On its way, on panels too.
  void pointer_moved(const input::Pixel& at);
  /// What the next picture is drawn for. Depth follows.
  void look_from(const stereo::SeenFrom& seen);
  void set_eyes_facts(std::optional<toolkit::EyesFacts> facts);
  void set_panel(const render::PanelPlace& panel);
  /// Follows the model server: its generation, its drag, its notices. Errors: a model too large for the GPU.
  Result<void> follow();
  /// Has levels of detail made of what is shown, and takes them over. Call it in each turn of the loop. Errors: no graphics memory.
  Result<void> make_levels();
  /// Draws a piece of what picking needs, in about `budget_ns`. Returns whether it is whole.
  bool prepare_picking(std::int64_t budget_ns);
  /// When make_levels must be called at the latest; nothing: there is nothing to do.
  std::optional<std::int64_t> next_levels_ns() const { return levels_.next_ns(context_.clock.now_ns()); }

  /// Somebody did something. True: nothing else may get it. `fresh`: not the repetition of a key that is held down.
  bool takes_input(bool fresh) { return tools_.takes_input(fresh); }
  bool allow_command(const input::Command& command) { return tools_.allow_command(command); }
  /// When `follow` must be called at the latest; negative: whenever.
  std::int64_t next_follow_ns() const { return tools_.next_ns(context_.clock.now_ns()); }

  input::Under under(const input::Pixel& pixel) const { return tools_.under(pixel); }  ///< panels don't count
  void gesture(const input::Gesture& gesture);
  void cancel_gesture();
  /// Carries out a command; those of the window do nothing.
  void command(const input::Command& command, const toolkit::Pointer& pointer);
  /// Carries out what was asked for on a panel.
  void panel_action(const std::function<void()>& action);
  /// A panel asks for a command.
  void panel_command(const input::Command& command, const toolkit::Pointer& pointer = std::nullopt);

  /// Opens the search with a text that was typed beside a field.
  void find(const std::string& begun);
  bool dialog_open() const { return context_.open.dialog.owner != nullptr || tools_.asking() != nullptr; }
  /// Replies to the question that is asked, if the key does that.
  bool reply_by_key(display::Key key);
  /// Whether a typed digit begins a number.
  bool takes_numbers(const toolkit::Pointer& pointer) const;
  /// `text`: typed so far.
  void begin_number(const std::string& text, const toolkit::Pointer& pointer);

  render::Picture picture() const;
  /// What the last picture left out, and the video memory that it took.
  void set_report(const render::DrawReport& report);
  /// What the panels show.
  toolkit::ToolContext& context() { return context_; }
  const toolkit::ToolContext& context() const { return context_; }
  const stereo::Profile& profile() const { return context_.view.profile; }
  /// Counts up with each change of the picture or the panels.
  std::uint64_t changes() const { return context_.changes; }
  /// Writes what a watching program needs to aim: the projection and the handle's place, when they changed.
  void trace_picture();

 private:
  void tell_video_memory();
  void take_newest();
  void set_up();
  void own_command(std::uint8_t number);
  void toggle_cover(toolkit::Cover cover);
  void open_menu(const toolkit::Pointer& pointer);
  void cancel(bool keep);

  notices::Notices notices_;
  toolkit::ToolSet tools_;
  toolkit::ToolContext context_;
  LevelsWorker levels_;
  std::uint64_t link_changes_ = 0;  ///< followed so far
  input::Pixel pointer_ = input::Pixel::Zero();
  // The line that tells what the last edit did: it goes when the pointer, which was there as it came, points at something else.
  std::uint64_t result_seen_ = 0;
  input::Pixel result_at_ = input::Pixel::Zero();
  bool result_left_ = false;
  std::string traced_aim_;
  std::string traced_notice_ = "reads none";
  // What was said of video memory about a document.
  std::uint64_t told_document_ = 0;
  render::GivenUp told_given_up_;
  bool told_exceeded_ = false;
  std::string traced_memory_;
};

}  // namespace prismesh::kiosk
