// The interface of a tool: a folder with its own state, keys, panel and part of the picture. All defaults do nothing. What only some tools
// can do is in abilities.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "kiosk/panels/panel_layout.h"
#include "kiosk/render/picture.h"
#include "kiosk/toolkit/pointer.h"

namespace prismesh::kiosk::toolkit {

class Tool {
 public:
  virtual ~Tool() = default;
  /// Owner of the tool's commands.
  virtual std::string_view name() const = 0;
  /// Carries out a command of the tool's own table.
  virtual void command(std::uint8_t /*number*/, const Pointer& /*pointer*/) {}

  // --- following the model ---

  /// The model server has said something. Before the newest state is taken. Errors: a model too large for the GPU.
  virtual Result<void> prepare() { return {}; }
  /// After it is taken. The last tool of the list follows first. Errors: as `prepare`.
  virtual Result<void> follow() { return {}; }
  /// The renderer has another model or another state of it.
  virtual void model_changed() {}
  /// The model is of another document than before: what was picked, pulled or typed on the old one is given up.
  virtual void document_changed() {}

  // --- the picture ---

  virtual void add_to_picture(render::Picture& /*picture*/) const {}
  /// What to do next, or what is shown; empty: nothing.
  virtual std::string guidance() const { return {}; }

  // --- the panel; drawn inside Gui::layout ---

  /// The tool's panel as the trace names it; empty: the tool has none.
  virtual std::string_view panel_name() const { return {}; }
  /// The panel, in the lower half of the dock while the tool is in hand.
  virtual void draw_panel(panels::PanelLayout& /*layout*/) {}
  /// The tool was taken in hand or put down.
  virtual void panel_changed() {}
};

}  // namespace prismesh::kiosk::toolkit
