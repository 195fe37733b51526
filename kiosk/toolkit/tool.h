// The interface of a tool: a folder with its own state, keys, gestures, panels and parts of the picture. All defaults do nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "kiosk/input/gestures.h"
#include "kiosk/panels/panel_layout.h"
#include "kiosk/panels/question.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::toolkit {

/// `pointer`: its pixel, if it is on the picture and on no panel.
using Pointer = std::optional<input::Pixel>;

class Tool {
 public:
  virtual ~Tool() = default;
  /// Owner of the tool's commands.
  virtual std::string_view name() const = 0;

  // --- keys and hand ---

  /// Carries out a command of the tool's own table.
  virtual void command(std::uint8_t /*number*/, const Pointer& /*pointer*/) {}
  /// Which part of the tool's handle a pixel is on; `picture`: none.
  virtual input::Under under(const input::Pixel& /*pixel*/) const { return input::Under::picture; }
  /// True: the gesture was for this tool, and no other one gets it.
  virtual bool gesture(const input::Gesture& /*gesture*/) { return false; }
  /// Whether a typed digit begins a number for this tool. `begin_number`: `text` has been typed so far; true: the tool takes it.
  virtual bool takes_numbers(const Pointer& /*pointer*/) const { return false; }
  virtual bool begin_number(const std::string& /*text*/, const Pointer& /*pointer*/) { return false; }

  // --- modes, drags, and how they end ---

  /// In a mode a tool gets gestures before the tools without one.
  virtual bool in_mode() const { return false; }
  /// Ends the mode; false: there was none.
  virtual bool leave_mode() { return false; }
  /// Gives up something that stays on, such as an axis; false: nothing is on.
  virtual bool take_back() { return false; }
  /// There was nothing else to give up: takes away what is selected.
  virtual void clear() {}
  /// Something follows the pointer.
  virtual bool dragging() const { return false; }
  /// Ends that without effect.
  virtual void cancel_gesture() {}
  /// The model is being pulled: no other preview or state may be shown.
  virtual bool pulling() const { return false; }
  /// Ends a preview of the tool on the model, as another tool begins its own.
  virtual void leave_preview() {}

  // --- following the model and the view ---

  /// The model server has said something. Before the newest state is taken. Errors: a model too large for the GPU.
  virtual Result<void> prepare() { return {}; }
  /// After it is taken. The last tool of the list follows first. Errors: as `prepare`.
  virtual Result<void> follow() { return {}; }
  /// The renderer has another model or another state of it.
  virtual void model_changed() {}
  /// The model is of another document than before: what was picked, pulled or typed on the old one is given up.
  virtual void document_changed() {}
  /// The view has changed, with the pointer there if a gesture did it.
  virtual void view_moved(const Pointer& /*pointer*/) {}
  /// Moves the view on before the next picture.
  virtual void look(std::int64_t /*now_ns*/) {}
  /// False: nothing can be edited now, and the tool has told the user why.
  virtual bool allow_edit() { return true; }
  /// An edit is about to be sent.
  virtual void edit_begins() {}

  // --- the picture ---

  virtual void add_to_picture(render::Picture& /*picture*/) const {}
  /// What the tool colours the model by, in a word; empty: nothing. `leave_colours`: takes these colours away; false: there were none.
  virtual std::string colours() const { return {}; }
  virtual bool leave_colours() { return false; }
  /// Which quality glyphs the tool hides, in words; empty: none.
  virtual std::string glyphs_hidden() const { return {}; }
  /// What to do next, or what is shown; empty: nothing.
  virtual std::string guidance() const { return {}; }
  /// Writes what a watching program needs of the picture, where it has changed.
  virtual void trace_picture() {}

  // --- panels; called inside Gui::layout ---

  /// The panel at the left as the trace names it; empty: the tool has none.
  virtual std::string_view panel_name() const { return {}; }
  virtual void draw_left(panels::PanelLayout& /*layout*/) {}
  /// The tool's panel was opened or closed.
  virtual void panel_changed() {}
  /// A section of the document's panel.
  virtual void draw_document_section(panels::PanelLayout& /*layout*/) {}
  /// A section of the panel at the right, and its height in pixels beyond the panel's own.
  virtual void draw_status(panels::PanelLayout& /*layout*/) {}
  virtual double status_height(double /*width*/) const { return 0; }
  /// The list that fills the rest of that panel, and its number of rows.
  virtual void draw_list(panels::PanelLayout& /*layout*/) {}
  virtual std::size_t list_rows() const { return 0; }
  /// What lies over the picture: moves the layout's `top` and `bottom` by what it takes.
  virtual void draw_over_picture(panels::PanelLayout& /*layout*/) {}
  /// The dialog of this kind. `opened`: it wasn't there the last time.
  virtual void draw_dialog(int /*kind*/, bool /*opened*/, panels::PanelLayout& /*layout*/) {}
  /// Whether that dialog hides the panels at the sides.
  virtual bool dialog_covers(int /*kind*/) const { return false; }
  /// A question that must be answered first; null: none.
  virtual const panels::Question* question() const { return nullptr; }
  virtual void reply(panels::Reply /*reply*/) {}
};

}  // namespace prismesh::kiosk::toolkit
