// What all tools share: the services that they call, and plain data that more than one of them reads or writes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/clock.h"
#include "drivers/space_mouse/space_mice.h"
#include "kiosk/input/command.h"
#include "kiosk/input/gestures.h"
#include "kiosk/link/model_link.h"
#include "kiosk/link/pen_link.h"
#include "kiosk/notices/notices.h"
#include "kiosk/notices/trace.h"
#include "kiosk/render/renderer.h"
#include "kiosk/toolkit/picture_view.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::toolkit {

class HasDialogs;
class Tool;
class ToolSet;

/// The document as it is shown.
struct ShownModel {
  std::shared_ptr<const ipc::SnapshotView> snapshot;  ///< the newest state; null: no document is open
  std::uint64_t document_number = 0;                  ///< FollowedDocument::number of it
  bool older = false;                                 ///< the renderer's model is an older state: nothing in it can be picked
};

/// What is under the pointer.
struct PointedAt {
  std::optional<mesh::NodeIndex> node;    ///< the nearest one within reach
  std::optional<mesh::ShellIndex> shell;  ///< of the shown model
  std::string words;                      ///< "node 17 (1.2 3.4 5.6) mm   shell 4   part 2 Sill"; empty: nothing is
};

/// Where the pointer is, also on its way.
struct HandPlace {
  std::optional<input::Pixel> at;           ///< none: on a panel, or beside the window
  input::Under on = input::Under::picture;  ///< the part of a handle that a press would take
  bool operator==(const HandPlace&) const = default;
};

/// The selection as the next gesture meets it.
struct SelectionFocus {
  std::optional<mesh::NodeIndex> last_clicked;
  std::optional<mesh::document::SelectRegion> last_region;  ///< the last edit, if it selected a region
  std::optional<mesh::Vec3> centre;                         ///< of the selected nodes
  double crease_angle = 30;                                 ///< degrees: sharper edges are creases
};

/// What covers the view.
enum class Cover : std::uint8_t { none, menu, help, warnings };

struct OpenPanels {
  /// A box that is typed into. Its owner may have several kinds.
  struct Dialog {
    HasDialogs* owner = nullptr;  ///< null: no dialog is open
    int kind = 0;
    bool operator==(const Dialog&) const = default;
  };
  Tool* in_hand = nullptr;  ///< whose panel and options are shown; null: those of `usual`
  Tool* usual = nullptr;    ///< the tool that selects
  Dialog dialog;
  std::string begun{};                    ///< what the search begins with, the next time it is opened
  std::optional<input::Pixel> menu_at{};  ///< where the menu of what is under the pointer was asked for
  Cover cover = Cover::none;
};

/// A program that visitors use, and that leads back to its beginning (docs/exhibition.md).
struct ExhibitionOptions {
  std::filesystem::path deck;  ///< what is shown, absolute
  std::string show_file;       ///< names the show in errors
  std::string show_text;       ///< checked already
  std::int64_t idle_ns = 0;
  std::int64_t warning_ns = 0;
  std::string pin;              ///< a hash of crypt(3); empty: there is no way out by hand
  std::filesystem::path tries;  ///< where wrong PINs are kept; empty: nowhere
  input::Command leave;         ///< asks for the PIN
  input::Command fullscreen;    ///< does nothing
  input::Command set_up;        ///< is refused until the PIN is given
};

struct ToolOptions {
  std::filesystem::path expressions{};    ///< file of the entered expressions; empty: none
  std::filesystem::path commands_used{};  ///< file of the commands that were found; empty: none
  std::filesystem::path decks_opened{};   ///< file of the decks that were opened; empty: none
  std::filesystem::path setup{};          ///< socket of prismesh-setup, which sets the station up; empty: none
  std::filesystem::path intake{};         ///< socket of prismesh-intake, whose models can be opened; empty: none
  bool follows_others = false;            ///< moves together with other kiosks that do
  std::string title{};                    ///< shown where no tool guides the user
  std::optional<ExhibitionOptions> exhibition{};
  input::Command fit{};  ///< fits the view
};

struct ToolContext {
  link::ModelLink& link;
  link::PenLink& pen;
  render::Renderer& renderer;
  Clock& clock;
  notices::Trace trace;
  notices::Notices& notices;
  ToolSet& tools;
  ToolOptions options{};
  drivers::space_mouse::SpaceMice* space_mice = nullptr;  ///< null: none are read here
  std::span<const input::KeyBinding> commands{};          ///< of all tools and the editor

  PictureView view{};
  ShownModel shown{};
  SelectionFocus selection{};
  PointedAt pointed{};
  HandPlace hand{};
  OpenPanels open{};
  std::size_t glyphs_left_out = 0;     ///< glyphs that the last picture had no room for
  render::VideoMemory video_memory{};  ///< as of the last picture
  std::uint64_t changes = 0;           ///< counts up with each change of the picture or the panels
  bool keeps_apart = false;            ///< edits make no new contact
  bool quits = false;                  ///< the window closes
  bool anew = false;                   ///< and everything is made anew in it
  bool sets_up = false;                ///< after the station's set-up
  bool follow_soon = false;            ///< follow at the next turn, even if the server says nothing
};

}  // namespace prismesh::kiosk::toolkit
