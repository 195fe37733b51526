// Hides, shows and locks parts and include files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/parts/part_list.h"

namespace prismesh::kiosk::tools::parts {

std::span<const input::KeyBinding> keys();

class PartsTool final : public toolkit::Tool, public toolkit::HasTab {
 public:
  explicit PartsTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  const char* tab() const override { return "Parts"; }
  void draw_tab(panels::PanelLayout& layout) override;

 private:
  std::optional<mesh::PartIndex> part_at(const toolkit::Pointer& pointer) const;
  void set_part(mesh::document::VisibilityAction action, const toolkit::Pointer& pointer);
  void set_file(mesh::document::VisibilityAction action, const toolkit::Pointer& pointer);
  void show_all();
  /// `on`: an expression of parts; none: those of the selection.
  void set(const std::optional<std::string>& on, mesh::document::VisibilityAction action);
  PartFacts facts() const;

  toolkit::ToolContext& context_;
};

}  // namespace prismesh::kiosk::tools::parts
