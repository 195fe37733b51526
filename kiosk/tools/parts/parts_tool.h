// Hides, shows and locks parts and include files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kiosk/tools/parts/part_list.h"
#include "kiosk/tools/tool.h"
#include "kiosk/tools/tool_context.h"

namespace prismesh::kiosk::tools::parts {

std::span<const KeyBinding> keys();

class PartsTool final : public Tool {
 public:
  explicit PartsTool(ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const Pointer& pointer) override;
  void draw_list(PanelLayout& layout) override;
  std::size_t list_rows() const override;

 private:
  std::optional<mesh::PartIndex> part_at(const Pointer& pointer) const;
  void set_part(mesh::document::VisibilityAction action, const Pointer& pointer);
  void set_file(mesh::document::VisibilityAction action, const Pointer& pointer);
  void show_all();
  /// `on`: an expression of parts; none: those of the selection.
  void set(const std::optional<std::string>& on, mesh::document::VisibilityAction action);
  PartFacts facts() const;

  ToolContext& context_;
};

}  // namespace prismesh::kiosk::tools::parts
