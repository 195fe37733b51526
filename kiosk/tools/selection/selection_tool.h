// Selects: by clicks, outlines, regions and expressions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/history_file.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/selection/expression_box.h"
#include "kiosk/tools/selection/select_section.h"

namespace prismesh::kiosk::tools::selection {

std::span<const input::KeyBinding> keys();

class SelectionTool final : public toolkit::Tool,
                            public toolkit::TakesGestures,
                            public toolkit::Drags,
                            public toolkit::Clears,
                            public toolkit::SetsRegion,
                            public toolkit::InRail,
                            public toolkit::HasOptions,
                            public toolkit::HasDialogs {
 public:
  explicit SelectionTool(toolkit::ToolContext& context) : context_(context), expressions_(context.options.expressions) {
    context.open.usual = this;
  }

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  void clear() override;
  mesh::document::SelectRegion region(std::int64_t node) const override;
  bool dragging() const override { return rubber_band_.has_value() || !lasso_.empty(); }
  void cancel_gesture() override;
  void add_to_picture(render::Picture& picture) const override;
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  void click(const input::NodeClicked& click);
  void step_back();
  void draw(const input::OutlineDrawn& outline);
  void take(const input::OutlineDone& outline);
  bool is_rectangle(bool other_kind) const { return draws_lasso_ == other_kind; }
  void select_node(mesh::NodeIndex node, mesh::document::SelectMode mode);
  void select_region(const input::Pixel& at, mesh::document::SelectMode mode);
  void change_angle(double degrees);
  void set_region(const RegionSettings& region);
  void enter(const ExpressionEntered& entered);

  toolkit::ToolContext& context_;
  bool draws_lasso_ = true;
  bool through_ = false;
  mesh::document::RegionBy region_by_ = mesh::document::RegionBy::features;
  bool region_across_welds_ = false;
  toolkit::HistoryFile expressions_;
  ExpressionEntry entry_;
  std::optional<render::PixelRect> rubber_band_;
  std::vector<input::Pixel> lasso_;
};

}  // namespace prismesh::kiosk::tools::selection
