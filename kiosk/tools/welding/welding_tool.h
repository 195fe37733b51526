// Welds along a flange: a click on it shows every weld before it is made, dragging one sets the pitch, Enter makes them. Beside it the list
// of what is wrong with welds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/link/edit_preview.h"
#include "kiosk/panels/entry_box.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/welding/weld_list.h"

namespace prismesh::kiosk::tools::welding {

std::span<const input::KeyBinding> keys();

class WeldingTool final : public toolkit::Tool,
                          public toolkit::TakesGestures,
                          public toolkit::HasHandle,
                          public toolkit::Drags,
                          public toolkit::HasMode,
                          public toolkit::Previews,
                          public toolkit::InRail,
                          public toolkit::HasOptions,
                          public toolkit::HasDialogs,
                          public toolkit::TellsLive {
 public:
  explicit WeldingTool(toolkit::ToolContext& context) : context_(context), preview_(context.link.connection), list_(context.link) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  input::Under under(const input::Pixel& pixel) const override;
  toolkit::HandlePart part_at(const input::Pixel& pixel) const override;
  bool pulling() const override { return false; }
  bool dragging() const override { return drag_.has_value(); }
  void cancel_gesture() override;
  bool in_mode() const override { return in_mode_; }
  bool leave_mode() override;
  void leave_preview() override;
  bool carry_out_preview() override;
  void panel_changed() override;
  void document_changed() override;
  Result<void> follow() override;
  void add_to_picture(render::Picture& picture) const override;
  std::string guidance() const override;
  std::string_view panel_name() const override { return "weld"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  std::string live_words() const override;
  std::string value_at_hand() const override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  enum class Typed : std::uint8_t { pitch, diameter };
  /// The welds that would be made.
  struct WantedWelds {
    std::int64_t node = 0;  ///< id of the one that was clicked
    std::uint64_t generation = 0;
    std::optional<ipc::EditPreviewed> would;  ///< the newest answer
    std::string problem;                      ///< or why there is none
    std::uint64_t answer = 0;                 ///< its number
    bool asking = false;
    bool changed = false;  ///< since it was asked
  };
  /// A weld of the preview that follows the pointer.
  struct DraggedWeld {
    input::Pixel from, taken;  ///< the first weld, and where the weld was taken
    double pitch = 0;          ///< when it was taken
  };

  bool is_shown() const { return wanted_ && wanted_->would.has_value(); }
  double pitch() const;
  mesh::document::Weld edit() const;
  std::optional<input::Pixel> pixel_of(std::size_t line) const;
  /// The shown weld at a pixel; nothing while one is dragged.
  std::optional<std::size_t> weld_at(const input::Pixel& pixel) const;
  void click(const input::Pixel& at);
  void ask();
  void set_pitch(double pitch);
  void drag_to(const input::Pixel& at);
  void repair();
  void go_to(std::size_t finding);
  void step(int by);
  void forget();
  void take_answer();
  std::string pitch_words() const;
  std::string like_words() const;

  toolkit::ToolContext& context_;
  link::EditPreview preview_;
  WeldList list_;
  bool in_mode_ = false;
  std::optional<double> pitch_, diameter_;  ///< as set; nothing: five sides of a shell; like the nearest weld
  std::optional<WantedWelds> wanted_;
  std::optional<DraggedWeld> drag_;
  std::optional<std::size_t> finding_;  ///< that the view went to
  std::uint64_t told_ = 0;              ///< answer of the list
  panels::EntryState entry_;
  std::string begun_, problem_;
};

}  // namespace prismesh::kiosk::tools::welding
