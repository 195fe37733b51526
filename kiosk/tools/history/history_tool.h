// Lists the states that undo and redo move among, goes to any of them, and asks before an edit sets the newer ones aside.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/history/state_list.h"

namespace prismesh::kiosk::tools::history {

class HistoryTool final : public toolkit::Tool, public toolkit::HasTab, public toolkit::HoldsEdits, public toolkit::AsksQuestions {
 public:
  explicit HistoryTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override { return "history"; }
  Result<void> follow() override;
  void document_changed() override;
  const char* tab() const override { return "History"; }
  void draw_tab(panels::PanelLayout& layout) override;
  bool would_hold(const mesh::document::Edit& edit) const override;
  bool hold(const mesh::document::Edit& edit, bool sends) override;
  const panels::Question* question() const override { return question_ ? &*question_ : nullptr; }
  void reply(panels::Reply reply) override;

 private:
  void go_to(std::uint64_t generation);
  StateFacts facts() const;
  /// The newer states that an edit would set aside, in words, if the user must be asked; they may be unknown. Nothing: it needs no
  /// question.
  std::optional<std::vector<std::string>> lost_by(const mesh::document::Edit& edit) const;
  void ask(const std::vector<std::string>& lost);

  toolkit::ToolContext& context_;
  std::optional<std::uint64_t> scrolled_to_;     ///< the state that the list shows in its middle
  std::optional<std::uint64_t> stepping_from_;   ///< an undo from this state was sent
  std::optional<std::uint64_t> may_give_up_of_;  ///< the newer states of this one may be given up
  std::optional<mesh::document::Edit> held_;     ///< to be sent if the user agrees
  std::optional<panels::Question> question_;
};

}  // namespace prismesh::kiosk::tools::history
