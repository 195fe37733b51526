// All tools of the kiosk, and what one of them or the editor asks of all.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/ability_lists.h"
#include "kiosk/toolkit/tool.h"

namespace prismesh::kiosk::toolkit {

class ToolSet {
 public:
  using All = std::vector<std::unique_ptr<Tool>>;
  void add(std::unique_ptr<Tool> tool);
  const All& all() const { return all_; }
  /// The tools with an ability, in the order of all.
  template <class Ability>
  const std::vector<Ability*>& with() const {
    return abilities_.with<Ability>();
  }

  /// False: no tool has this command.
  bool command(const input::Command& command, const Pointer& pointer);
  /// Offers a gesture: first to the tools in a mode.
  void gesture(const input::Gesture& gesture);
  input::Under under(const input::Pixel& pixel) const;
  /// HasHandle::part_at of the tool whose part `under` finds; no lines and no words: there is none.
  HandlePart part_at(const input::Pixel& pixel) const;
  /// The tool that asks a question; null: none does.
  AsksQuestions* asking() const;

  /// A tool is in a mode; `but`: that tool isn't counted.
  bool in_mode(const HasMode* but = nullptr) const;
  bool leave_mode();
  bool take_back();
  void clear();
  bool dragging() const;
  void cancel_gesture();
  bool pulling() const;
  void leave_previews();
  /// Does what a tool shows as a preview; false: none does.
  bool carry_out_preview();
  bool allow_edit();
  bool takes_input(bool fresh);
  bool allow_command(const input::Command& command);
  /// Of the tool that guards input and must be watched first; negative: none must.
  std::int64_t next_ns(std::int64_t now_ns) const;
  bool would_hold(const mesh::document::Edit& edit) const;
  /// HoldsEdits::hold of the first tool that does.
  bool hold(const mesh::document::Edit& edit, bool sends);
  void watch(std::int64_t now_ns);
  /// Of the tool that sets it.
  mesh::document::Shaping shaping(std::int64_t grab, const mesh::Vec3& middle) const;
  mesh::document::SelectRegion region(std::int64_t node) const;
  void edit_begins();
  void view_moved(const Pointer& pointer = {});
  void panel_changed();

  std::string colours() const;
  bool leave_colours();
  std::string glyphs_hidden() const;
  /// Of the tools in a mode first.
  std::string guidance() const;

 private:
  /// Null: no handle is there.
  const HasHandle* handle_at(const input::Pixel& pixel) const;
  /// A tool, with the abilities that its mode gives priority to.
  struct Moded {
    Tool* tool = nullptr;
    TakesGestures* gestures = nullptr;  ///< null: it takes none
    HasMode* mode = nullptr;            ///< null: it has none
    bool in_mode() const { return mode != nullptr && mode->in_mode(); }
  };

  All all_;
  std::vector<Moded> moded_;  ///< all of them
  AbilityLists<TakesNumbers, GuardsInput, HasHandle, Drags, Watches, HasMode, TakesBack, Clears, GuardsEdits, HoldsEdits, SetsShaping,
               SetsRegion, Previews, MovesView, FollowsView, ColoursModel, HidesGlyphs, TracesPicture, HasStatus, HasLight, HasTab, InRail,
               HasOptions, TellsLive, HasMenuEntries, DrawsOverPicture, HasDialogs, AsksQuestions>
      abilities_;
};

}  // namespace prismesh::kiosk::toolkit
