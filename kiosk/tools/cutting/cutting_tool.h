// Cuts the model open with a plane that is dragged by an arrow: what lies above it is neither shown nor picked, and the curves in which it
// cuts the shells are drawn. It is a view: no edit, and nothing of it is saved.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kiosk/panels/entry_box.h"
#include "kiosk/render/model_copy.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/arrow.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::tools::cutting {

std::span<const input::KeyBinding> keys();

class CuttingTool final : public toolkit::Tool,
                          public toolkit::TakesGestures,
                          public toolkit::TakesNumbers,
                          public toolkit::HasHandle,
                          public toolkit::Drags,
                          public toolkit::HasMode,
                          public toolkit::TakesBack,
                          public toolkit::FollowsView,
                          public toolkit::MovesView,
                          public toolkit::InRail,
                          public toolkit::HasOptions,
                          public toolkit::HasDialogs,
                          public toolkit::TellsLive,
                          public toolkit::TracesPicture {
 public:
  explicit CuttingTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  bool takes_numbers(const toolkit::Pointer& pointer) const override;
  bool begin_number(const std::string& text, const toolkit::Pointer& pointer) override;
  input::Under under(const input::Pixel& pixel) const override;
  toolkit::HandlePart part_at(const input::Pixel& pixel) const override;
  bool pulling() const override { return false; }
  bool dragging() const override { return drag_.has_value(); }
  void cancel_gesture() override;
  /// While the plane is dragged its gestures go first.
  bool in_mode() const override { return dragging(); }
  bool leave_mode() override;
  bool take_back() override;
  void view_moved(const toolkit::Pointer& pointer) override;
  void model_changed() override;
  /// Cuts anew if the other view shows another model. The view stays.
  void look(std::int64_t now_ns) override;
  void document_changed() override { set_plane(std::nullopt); }
  void add_to_picture(render::Picture& picture) const override;
  std::string_view panel_name() const override { return "cut"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  std::string live_words() const override;
  std::string value_at_hand() const override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;
  void trace_picture() override;

 private:
  /// Across an axis of the deck, or the view as it was.
  enum class Across : std::uint8_t { x, y, z, view };
  struct CutPlane {
    Across across = Across::x;
    bool flipped = false;                   ///< the arrow points against the axis
    mesh::Vec3 axis = mesh::Vec3::UnitX();  ///< unit
    mesh::Vec3 point = mesh::Vec3::Zero();  ///< where the arrow stands

    mesh::Vec3 normal() const { return flipped ? mesh::Vec3(-axis) : axis; }
    double place() const { return point.dot(axis); }  ///< of the plane on the axis through the deck's origin
  };
  struct Dragged {
    toolkit::ArrowPull pull;
    mesh::Vec3 from;
    double distance = 0;
  };
  void next_axis();
  void across_view();
  void flip();
  void set_plane(const std::optional<CutPlane>& plane);
  void move_to(const mesh::Vec3& point);
  /// Cuts the shown model and hands the curves to the renderer.
  void cut();
  std::string words() const;

  toolkit::ToolContext& context_;
  std::optional<CutPlane> plane_;
  std::optional<Dragged> drag_;
  render::ModelCopy copy_;    ///< of the shown model; empty: nothing is cut
  render::ModelCopy beside_;  ///< of the model in the other view
  std::vector<std::uint64_t> beside_versions_;
  double length_ = 0;       ///< of the curves
  std::size_t shells_ = 0;  ///< that are cut
  panels::EntryState entry_;
  std::string begun_, problem_;
  std::string traced_;
};

}  // namespace prismesh::kiosk::tools::cutting
