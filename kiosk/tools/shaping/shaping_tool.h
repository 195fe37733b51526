// Pulls the surface by the selection's handle, turns it about an axis, and takes numbers for both.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kiosk/panels/number_box.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/shaping/axis_pick.h"
#include "kiosk/tools/shaping/falloff_ring.h"
#include "kiosk/tools/shaping/followed_edges.h"
#include "kiosk/tools/shaping/handle.h"
#include "kiosk/tools/shaping/pull_preview.h"
#include "kiosk/tools/shaping/shaping_commands.h"
#include "kiosk/tools/shaping/shaping_options.h"
#include "kiosk/tools/shaping/shaping_panel.h"

namespace prismesh::kiosk::tools::shaping {

std::span<const input::KeyBinding> keys();

class ShapingTool final : public toolkit::Tool,
                          public toolkit::TakesGestures,
                          public toolkit::TakesNumbers,
                          public toolkit::HasHandle,
                          public toolkit::Drags,
                          public toolkit::HasMode,
                          public toolkit::TakesBack,
                          public toolkit::SetsShaping,
                          public toolkit::FollowsView,
                          public toolkit::TracesPicture,
                          public toolkit::InRail,
                          public toolkit::HasOptions,
                          public toolkit::TellsLive,
                          public toolkit::GuardsEdits,
                          public toolkit::Previews,
                          public toolkit::HasDialogs {
 public:
  explicit ShapingTool(toolkit::ToolContext& context)
      : context_(context), preview_(context.link.drag, context.renderer, context.trace), followed_(context.link.connection) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  input::Under under(const input::Pixel& pixel) const override;
  toolkit::HandlePart part_at(const input::Pixel& pixel) const override;
  bool gesture(const input::Gesture& gesture) override;
  bool takes_numbers(const toolkit::Pointer& pointer) const override;
  bool begin_number(const std::string& text, const toolkit::Pointer& pointer) override;
  bool in_mode() const override { return axis_pick_.active(); }
  bool leave_mode() override;
  bool take_back() override;
  bool dragging() const override { return ring_drag_ || (pull_ && !pull_->by_number); }
  void cancel_gesture() override;
  bool pulling() const override { return pull_.has_value(); }
  bool allow_edit() override { return true; }
  void edit_begins() override { leave_preview(); }
  void leave_preview() override;
  mesh::document::Shaping shaping(std::int64_t grab, const Vec3& middle) const override {
    return shaping_of(options_, {input::Under::move_handle, grab, middle});
  }
  Result<void> follow() override;
  void model_changed() override;
  void document_changed() override;
  void view_moved(const toolkit::Pointer& pointer) override;
  void add_to_picture(render::Picture& picture) const override;
  std::string guidance() const override;
  void trace_picture() override;
  std::string_view panel_name() const override { return "shaping"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::string live_words() const override;
  std::string value_at_hand() const override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  /// What the number that is being typed is for.
  struct Typing {
    enum class For : std::uint8_t { pull, move_limit, symmetry_place } what = For::pull;
    std::string begun{};
    std::string problem{};
    std::optional<input::Pixel> at{};        ///< of the pointer, if the box stands there
    Pull from{};                             ///< the pull before the first digit: where one number for disk or ring goes
    std::optional<std::string> previewed{};  ///< the text that is shown as a preview, or can't be
    bool refused = false;                    ///< the server refuses the preview
  };
  /// What two nodes are picked for.
  enum class TwoNodes : std::uint8_t { axis, falloff };
  /// A pull under way.
  struct ActivePull {
    HandlePull pull;
    input::Pixel pointer = input::Pixel::Zero();
    bool axis_known = false;      ///< the server has told the normal: only then it understands a distance
    bool released_early = false;  ///< before that
    std::optional<Pull> typed{};  ///< so far, whatever the pointer says; of a lift: along the arrow
    bool by_number = false;       ///< no pointer pulls: it shows a number that is being typed
    bool entered = false;         ///< that number
    ShapingOptions options{};     ///< as it began
  };

  std::optional<render::Handle> shown_handle() const;
  bool is_typing() const { return context_.open.dialog.owner == this; }

  // --- pulls ---
  void begin_pull(input::Under handle, const input::Pixel& at);
  void pull_to(const input::Pixel& pixel);
  void send_typed();
  void take_axis(const link::RunningDrag& drag);
  void ask_followed_edges();
  bool take_handle_gesture(const input::Gesture& gesture);

  // --- the ring of the falloff ---
  HalfwayLine shown_ring() const;
  bool take_ring_gesture(const input::Gesture& gesture);
  std::string ring_words(const input::Pixel& at) const;

  // --- axes ---
  void set_axis(const std::optional<Axis>& axis, const std::string& what);
  void pick_two_nodes(TwoNodes purpose);
  void click_node(const input::Pixel& at);
  std::optional<EdgeAxis> edge_under(const toolkit::Pointer& pointer) const;
  void axis_from_edge(const toolkit::Pointer& pointer);
  void axis_from_deck(DeckAxis axis);

  // --- the direction of the falloff ---
  void set_falloff(const FalloffDirection& along);
  void falloff_from_edge(const toolkit::Pointer& pointer);

  // --- numbers and options ---
  void type_for(Typing::For what, const std::optional<double>& now);
  void enter_number(const std::string& text);
  void enter_pull(const std::string& text);
  bool types_pull() const { return is_typing() && typing_.what == Typing::For::pull; }
  bool wants_preview(const std::string& text) const;
  void preview_number(const std::string& text);
  void end_number_preview();
  void follow_typing();
  PullFacts pull_facts() const;
  void enter_option(const std::string& text);
  std::optional<Vec3> typed_direction() const;
  void next_handle();
  void change_option(ShapingCommand command);

  std::string touching() const;

  toolkit::ToolContext& context_;
  ShapingOptions options_;
  input::Under handle_ = input::Under::lift_handle;  ///< the part of the handle that numbers are typed for
  AxisPick axis_pick_;
  TwoNodes picks_ = TwoNodes::axis;
  std::optional<Axis> axis_;
  std::optional<Anchor> anchor_;
  std::optional<ActivePull> pull_;
  Pull pulled_;  ///< of the pull under way, or else of the last one
  PullPreview preview_;
  FollowedEdges followed_;
  std::optional<RingDrag> ring_drag_;
  double flat_before_ = 0;  ///< the drag of the ring
  Typing typing_;
  panels::EntryState entry_;
  std::string traced_;
  std::uint64_t traced_followed_ = 0;
  std::string traced_ring_ = "falloff ring none";
  std::string traced_touch_;
};

}  // namespace prismesh::kiosk::tools::shaping
