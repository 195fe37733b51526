// Reviews the shells' quality in figures, goes to errors one after the other, and relaxes and repairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/panels/entry_box.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/quality/mend_limits.h"
#include "kiosk/tools/quality/quality_facts.h"
#include "kiosk/tools/quality/quality_link.h"

namespace prismesh::kiosk::tools::quality {

std::span<const input::KeyBinding> keys();

class QualityTool final : public toolkit::Tool,
                          public toolkit::HidesGlyphs,
                          public toolkit::HasStatus,
                          public toolkit::InRail,
                          public toolkit::HasOptions,
                          public toolkit::HasDialogs {
 public:
  explicit QualityTool(toolkit::ToolContext& context)
      : context_(context), link_(context.link, [&context](mesh::document::Edit edit) { toolkit::send(context, std::move(edit)); }) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  Result<void> follow() override;
  void document_changed() override;
  void add_to_picture(render::Picture& picture) const override;
  std::string glyphs_hidden() const override;
  std::string_view panel_name() const override { return "quality"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void panel_changed() override;
  void draw_status(panels::PanelLayout& layout) override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  bool is_the_error(const ipc::QualityError& error) const { return error.shell == error_shell_ && error.node == error_node_; }
  bool is_open() const { return context_.open.in_hand == this; }
  void follow_figures();
  void relax(mesh::document::Scope scope);
  void relax_from(const toolkit::Pointer& pointer);
  void repair(mesh::document::Scope scope);
  void type_limit(MendLimit which);
  void enter_limit(MendLimit which, const std::string& text);
  void next_glyphs();
  std::string glyph_words() const;
  void choose_metric(const std::string& metric);
  void select_bar(const BarClicked& bar);
  void act(const QualityAction& action);
  void list_criteria();
  std::optional<SizeFacts> size_facts(const ipc::SnapshotInfo& info) const;
  double target_size_at(const std::optional<mesh::ShellIndex>& shell) const;
  void step_error(int by);
  void go_to_error(std::size_t error);
  void leave_error();

  toolkit::ToolContext& context_;
  QualityLink link_;
  QualityLink::Wish wish_;
  bool without_glyphs_ = false;
  std::optional<std::size_t> error_;  ///< the error that the view went to, by its place in the list
  std::int64_t error_shell_ = 0;      ///< its shell, by id
  std::int64_t error_node_ = 0;       ///< its node, by id; 0: it is of a shell
  std::optional<mesh::ShellIndex> marked_;
  std::vector<std::filesystem::path> criteria_files_;  ///< beside the deck, when the list was last opened
  MendLimits limits_;
  std::string limit_problem_;  ///< what is wrong with the number that is being typed
  panels::EntryState entry_;
  std::string traced_;
};

}  // namespace prismesh::kiosk::tools::quality
