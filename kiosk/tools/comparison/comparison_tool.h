// Compares: colours by a field, two views side by side, and the states before and after the last edit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/comparison/before_after.h"
#include "kiosk/tools/comparison/comparing.h"

namespace prismesh::kiosk::tools::comparison {

std::span<const input::KeyBinding> keys();

class ComparisonTool final : public toolkit::Tool,
                             public toolkit::TakesBack,
                             public toolkit::GuardsEdits,
                             public toolkit::ColoursModel,
                             public toolkit::HidesGlyphs,
                             public toolkit::DrawsOverPicture,
                             public toolkit::InRail,
                             public toolkit::HasOptions {
 public:
  explicit ComparisonTool(toolkit::ToolContext& context)
      : context_(context),
        comparing_(context.link, context.renderer, context.trace),
        before_after_(context.link, comparing_, context.notices, context.trace) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool take_back() override;
  Result<void> prepare() override;
  bool allow_edit() override;
  void edit_begins() override { comparing_.show_current(); }
  void add_to_picture(render::Picture& picture) const override;
  std::string colours() const override { return comparing_.wish().field.empty() ? std::string() : "values"; }
  bool leave_colours() override;
  std::string glyphs_hidden() const override { return comparing_.coloured() ? "no glyphs while values are shown" : ""; }
  std::string guidance() const override { return before_after_.words(); }
  std::string_view panel_name() const override { return "comparing"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void panel_changed() override { comparing_.open_panel(context_.open.in_hand == this); }
  void draw_over_picture(panels::PanelLayout& layout) override;

 private:
  void before_and_after();
  void turn_two_views();
  void set(const CompareWish& wish);
  Result<void> set_model();
  void resize_view(double by);
  void probe(LegendFacts& legend) const;

  toolkit::ToolContext& context_;
  Comparing comparing_;
  BeforeAfter before_after_;
  CompareEntry entry_;
  std::shared_ptr<const ipc::SnapshotView> drawn_;  ///< the renderer's model: the current state, or an older one
  std::vector<std::uint8_t> drawn_hidden_;          ///< the parts that it hides
};

}  // namespace prismesh::kiosk::tools::comparison
