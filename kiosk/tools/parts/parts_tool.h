// Hides, shows and locks parts and include files, and lists them. Their colours and transparency are this kiosk's own.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/parts/part_errors.h"
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
  void document_changed() override;

 private:
  std::optional<mesh::PartIndex> part_at(const toolkit::Pointer& pointer) const;
  void set_part(mesh::document::VisibilityAction action, const toolkit::Pointer& pointer);
  void set_file(mesh::document::VisibilityAction action, const toolkit::Pointer& pointer);
  void show_all();
  /// `on`: an expression of parts; none: those of the selection.
  void set(const std::optional<std::string>& on, mesh::document::VisibilityAction action);
  void bring_facts();
  PartFacts facts(const std::vector<Errors>& errors) const;
  render::PartPaint paint_of(std::int64_t part) const;
  void paint(const SetPaint& wanted);
  void show_paints();

  /// What the facts of the tree were made from.
  struct Facts {
    std::shared_ptr<const ipc::SnapshotView> snapshot;
    std::size_t files = 0;
    std::uint64_t paints = 0;
    bool operator==(const Facts&) const = default;
  };

  toolkit::ToolContext& context_;
  PartTree tree_;
  PartErrors errors_;
  Facts facts_from_;
  std::map<std::int64_t, render::PartPaint> paints_;  ///< by part id
  std::uint64_t paint_changes_ = 0;
};

}  // namespace prismesh::kiosk::tools::parts
