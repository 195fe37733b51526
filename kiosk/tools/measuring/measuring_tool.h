// Measures between nodes that are clicked: distances, angles, radii. They stay, and follow the edits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/render/model_copy.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/measuring/measure_list.h"

namespace prismesh::kiosk::tools::measuring {

std::span<const input::KeyBinding> keys();

class MeasuringTool final : public toolkit::Tool,
                            public toolkit::TakesGestures,
                            public toolkit::HasMode,
                            public toolkit::InRail,
                            public toolkit::HasOptions,
                            public toolkit::DrawsOverPicture,
                            public toolkit::TracesPicture {
 public:
  explicit MeasuringTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  bool in_mode() const override { return nodes_wanted_ != 0; }
  bool leave_mode() override;
  void panel_changed() override;
  void model_changed() override;
  void document_changed() override;
  void add_to_picture(render::Picture& picture) const override;
  std::string guidance() const override;
  std::string_view panel_name() const override { return "measure"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void draw_over_picture(panels::PanelLayout& layout) override;
  void trace_picture() override;

 private:
  void measure(std::size_t nodes);
  void compute();
  void remove(std::size_t index);
  void clear();
  /// Where a measure's label stands in the picture: at the middle of its way. Nothing: behind the eye, or its nodes aren't there.
  std::optional<input::Pixel> label_at(const Measure& measure) const;
  bool is_cut_away(const Measure& measure) const;

  toolkit::ToolContext& context_;
  MeasureList list_;
  render::ModelCopy copy_;        ///< of the shown model; empty: no measure needs it
  std::size_t nodes_wanted_ = 0;  ///< of the next measure; 0: clicks aren't for this tool
  std::vector<std::string> traced_;
};

}  // namespace prismesh::kiosk::tools::measuring
