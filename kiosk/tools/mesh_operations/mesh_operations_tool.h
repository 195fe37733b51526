// Operations on the mesh by hand: split, collapse, merge, swap. A click shows what one would do, a second click does it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kiosk/link/edit_preview.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/mesh_operations/by_hand.h"

namespace prismesh::kiosk::tools::mesh_operations {

std::span<const input::KeyBinding> keys();

class MeshOperationsTool final : public toolkit::Tool,
                                 public toolkit::TakesGestures,
                                 public toolkit::HasMode,
                                 public toolkit::Previews,
                                 public toolkit::InRail,
                                 public toolkit::HasOptions {
 public:
  explicit MeshOperationsTool(toolkit::ToolContext& context) : context_(context), preview_(context.link.connection) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  bool gesture(const input::Gesture& gesture) override;
  bool in_mode() const override { return chosen_.operation.has_value(); }
  bool leave_mode() override;
  void leave_preview() override;
  bool carry_out_preview() override;
  Result<void> follow() override;
  void document_changed() override { leave_preview(); }
  std::string guidance() const override;
  std::string_view panel_name() const override { return "mesh"; }
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;

 private:
  /// The operation that is chosen, and what it would be done to.
  struct Chosen {
    std::optional<mesh::repair::Operation> operation{};
    std::optional<HandTarget> target{};
    std::optional<mesh::document::Restructure> edit{};
    std::uint64_t generation = 0;
    std::uint64_t shown = 0;  ///< number of the preview that is in the picture; 0: none
  };
  void choose(mesh::repair::Operation operation, const toolkit::Pointer& pointer);
  void click(const input::Pixel& at);
  void forget();
  void end_kept_preview();
  void show_preview(const ipc::EditPreviewed& would);

  toolkit::ToolContext& context_;
  link::EditPreview preview_;
  Chosen chosen_;
  std::optional<std::uint64_t> kept_;  ///< generation whose preview stays until its edit is done
};

}  // namespace prismesh::kiosk::tools::mesh_operations
