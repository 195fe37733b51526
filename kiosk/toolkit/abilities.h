// What some tools can do beside what every tool is. A tool also derives from its abilities; only tools with an ability are asked for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/input/command.h"
#include "kiosk/input/gestures.h"
#include "kiosk/panels/option_row.h"
#include "kiosk/panels/panel_layout.h"
#include "kiosk/panels/question.h"
#include "kiosk/toolkit/handle_part.h"
#include "kiosk/toolkit/pointer.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::toolkit {

class Ability {
 public:
  virtual ~Ability() = default;
};

// --- the hand ---

class TakesGestures : public Ability {
 public:
  /// True: the gesture was for this tool, and no other one gets it.
  virtual bool gesture(const input::Gesture& gesture) = 0;
};

class TakesNumbers : public Ability {
 public:
  /// Whether a typed digit begins a number for this tool.
  virtual bool takes_numbers(const Pointer& pointer) const = 0;
  /// `text` has been typed so far; true: the tool takes it.
  virtual bool begin_number(const std::string& text, const Pointer& pointer) = 0;
};

/// Takes what the user does before anything else does.
class GuardsInput : public Ability {
 public:
  /// Somebody pressed, moved or typed something. True: nothing else gets it. `fresh`: not the repetition of a key that is held down.
  virtual bool takes_input(bool fresh) = 0;
  /// False: the command isn't carried out.
  virtual bool allow_command(const input::Command& command) = 0;
};

/// Has a handle in the picture that pulls the model.
class HasHandle : public Ability {
 public:
  /// Which part of the handle a pixel is on; `picture`: none.
  virtual input::Under under(const input::Pixel& pixel) const = 0;
  /// The part on a pixel that `under` finds something on: where it lies, and what dragging it does.
  virtual HandlePart part_at(const input::Pixel& pixel) const = 0;
  /// The model is being pulled: no other preview or state may be shown.
  virtual bool pulling() const = 0;
};

class Drags : public Ability {
 public:
  /// Something follows the pointer.
  virtual bool dragging() const = 0;
  /// Ends that without effect.
  virtual void cancel_gesture() = 0;
};

/// Follows what moves without a message, such as the haptic pen.
class Watches : public Ability {
 public:
  /// Looks at it, at each turn of the kiosk.
  virtual void watch(std::int64_t now_ns) = 0;
  /// When it must be watched at the latest; negative: whenever.
  virtual std::int64_t next_ns(std::int64_t /*now_ns*/) const { return -1; }
};

// --- what Esc ends ---

/// In a mode a tool gets gestures before the tools without one.
class HasMode : public Ability {
 public:
  virtual bool in_mode() const = 0;
  /// Ends the mode; false: there was none.
  virtual bool leave_mode() = 0;
};

class TakesBack : public Ability {
 public:
  /// Gives up something that stays on, such as an axis; false: nothing is on.
  virtual bool take_back() = 0;
};

class Clears : public Ability {
 public:
  /// There was nothing else to give up: takes away what is selected.
  virtual void clear() = 0;
};

// --- the model and the view ---

class GuardsEdits : public Ability {
 public:
  /// False: nothing can be edited now, and the tool has told the user why.
  virtual bool allow_edit() = 0;
  /// An edit is about to be sent.
  virtual void edit_begins() = 0;
};

/// Asks the user before some edits.
class HoldsEdits : public Ability {
 public:
  /// Whether `hold` would ask the user.
  virtual bool would_hold(const mesh::document::Edit& edit) const = 0;
  /// True: the edit must not be made now, as the user is asked first. If the user agrees, the tool sends it if `sends`; else the user makes
  /// it again.
  virtual bool hold(const mesh::document::Edit& edit, bool sends) = 0;
};

class SetsShaping : public Ability {
 public:
  /// What the hand has set for shaping edits that take a node. `middle`: of what moves, for a mirror without a place of its own.
  virtual mesh::document::Shaping shaping(std::int64_t grab, const mesh::Vec3& middle) const = 0;
};

class SetsRegion : public Ability {
 public:
  /// The region about a node, as the hand has set what bounds regions.
  virtual mesh::document::SelectRegion region(std::int64_t node) const = 0;
};

class Previews : public Ability {
 public:
  /// Ends a preview of the tool on the model, as another tool begins its own.
  virtual void leave_preview() = 0;
  /// Does what is shown as a preview; false: nothing is.
  virtual bool carry_out_preview() { return false; }
};

class MovesView : public Ability {
 public:
  /// Moves the view on before the next picture.
  virtual void look(std::int64_t now_ns) = 0;
};

class FollowsView : public Ability {
 public:
  /// The view has changed, with the pointer there if a gesture did it.
  virtual void view_moved(const Pointer& pointer) = 0;
};

// --- the picture ---

class ColoursModel : public Ability {
 public:
  /// What the tool colours the model by, in a word; empty: nothing.
  virtual std::string colours() const = 0;
  /// Takes these colours away; false: there were none.
  virtual bool leave_colours() = 0;
};

class HidesGlyphs : public Ability {
 public:
  /// Which quality glyphs the tool hides, in words; empty: none.
  virtual std::string glyphs_hidden() const = 0;
};

class TracesPicture : public Ability {
 public:
  /// Writes what a watching program needs of the picture, where it has changed.
  virtual void trace_picture() = 0;
};

// --- panels; drawn inside Gui::layout ---

/// Where a tool stands in the rail, from above.
enum class RailPlace : std::uint8_t { select, pull, turn, mesh, quality, contact, weld, measure, cut, compare, pen };

/// A button of the rail.
struct RailEntry {
  RailPlace place{};
  const char* label = "";
  const input::KeyBinding* key = nullptr;  ///< the command of the button
  bool on = false;                         ///< in hand, or at work
};

class InRail : public Ability {
 public:
  virtual std::vector<RailEntry> rail() const = 0;
};

/// Has settings that are seen while the tool is in hand.
class HasOptions : public Ability {
 public:
  /// The settings that are changed most, in the row below the view. They stand in the panel too.
  virtual void draw_options(panels::OptionRow& row) = 0;
  /// The tool and how it is set, in a few words: "Pull · smooth · mirror off".
  virtual std::string setting_words() const = 0;
};

/// Shows what changes while the hand pulls, in a few words: "Lift 12.4 mm, 416 nodes move".
class TellsLive : public Ability {
 public:
  virtual std::string live_words() const = 0;
  /// The value alone, which stands beside the pointer that pulls: "12.4 mm"; empty: no pointer does.
  virtual std::string value_at_hand() const = 0;
};

/// A word of the status line: a device, and whether all is well with it.
struct Light {
  std::string name, state;
  bool good = true;
};
class HasLight : public Ability {
 public:
  /// Nothing: there is nothing to say.
  virtual std::optional<Light> light() const = 0;
};

class HasStatus : public Ability {
 public:
  /// A section at the top of the dock's lower half, whatever tool is in hand.
  virtual void draw_status(panels::PanelLayout& layout) = 0;
};

/// Has a tab in the upper half of the dock.
class HasTab : public Ability {
 public:
  virtual const char* tab() const = 0;
  virtual void draw_tab(panels::PanelLayout& layout) = 0;
};

/// Adds entries to a menu beside the commands.
class HasMenuEntries : public Ability {
 public:
  virtual void draw_menu_entries(input::Menu menu, panels::PanelLayout& layout) = 0;
};

class DrawsOverPicture : public Ability {
 public:
  /// What lies over the picture: moves the layout's `top` and `bottom` by what it takes.
  virtual void draw_over_picture(panels::PanelLayout& layout) = 0;
};

class HasDialogs : public Ability {
 public:
  /// The dialog of this kind. `opened`: it wasn't there the last time.
  virtual void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) = 0;
};

class AsksQuestions : public Ability {
 public:
  /// A question that must be answered first; null: none.
  virtual const panels::Question* question() const = 0;
  virtual void reply(panels::Reply reply) = 0;
};

}  // namespace prismesh::kiosk::toolkit
