// Turns, moves and fits the view, and sets its colours, display profile and depth.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/view/shared_view.h"
#include "kiosk/tools/view/view_sections.h"

namespace prismesh::kiosk::tools::view {

std::span<const input::KeyBinding> keys();

class ViewTool final : public toolkit::Tool,
                       public toolkit::TakesGestures,
                       public toolkit::MovesView,
                       public toolkit::HasTab,
                       public toolkit::DrawsOverPicture,
                       public toolkit::HasMenuEntries {
 public:
  explicit ViewTool(toolkit::ToolContext& context) : context_(context), shared_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  Result<void> prepare() override;
  void document_changed() override { fit_model(); }
  void look(std::int64_t now_ns) override;
  const char* tab() const override { return "Display"; }
  void draw_tab(panels::PanelLayout& layout) override;
  void draw_over_picture(panels::PanelLayout& layout) override;
  void draw_menu_entries(input::Menu menu, panels::PanelLayout& layout) override;

 private:
  void orbit(const input::Orbited& orbit);
  void pan(const input::Panned& pan);
  void zoom(const input::Zoomed& zoom);
  void look_from(std::string_view side);
  void fit();
  void fit_model();
  void set_view(const stereo::View& view);
  void next_colours();
  void turn_thickness();
  std::string words_on_thickness() const;
  void next_profile();
  void take_profile(const std::string& name);
  void keep_selection(bool keep);
  StereoFacts stereo_facts() const;

  toolkit::ToolContext& context_;
  SharedView shared_;
  /// What was under the pointer where a drag began.
  struct Held {
    input::Pixel from;
    std::optional<mesh::Vec3> point;
  };
  std::optional<input::Pixel> orbit_from_;  ///< where the drag began that turned the view last
  std::optional<Held> panned_;              ///< of the drag that moved it last
};

}  // namespace prismesh::kiosk::tools::view
