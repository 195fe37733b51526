#include "kiosk/tools/history/history_tool.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/counted.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/tool_set.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::kiosk::tools::history {

using panels::Reply;

namespace {

/// "Lift, Lock": the first few, by name.
std::string some_of(const std::vector<std::string>& states) {
  constexpr std::size_t kNamed = 6;
  std::string names;
  for (std::size_t i = 0; i < states.size() && i < kNamed; ++i) names += (i == 0 ? "" : ", ") + states[i];
  return states.size() > kNamed ? names + ", .." : names;
}

}  // namespace

Result<void> HistoryTool::follow() {
  const auto& shown = context_.shown.snapshot;
  const std::optional<std::uint64_t> now = shown ? std::optional(shown->info().generation) : std::nullopt;
  if (stepping_from_ && stepping_from_ != now) stepping_from_.reset();
  if (may_give_up_of_ && may_give_up_of_ != now) may_give_up_of_.reset();
  // Only what could be lost has to be known while the list isn't seen.
  if (shown && shown->info().can_redo) context_.link.history.ask();
  return {};
}

void HistoryTool::document_changed() {
  stepping_from_.reset();
  may_give_up_of_.reset();
  held_.reset();
  question_.reset();
}

// --- the list ---

StateFacts HistoryTool::facts() const {
  StateFacts facts;
  for (const ipc::ListedGeneration& state : context_.link.history.states())
    facts.states.push_back({state.number, words_of_maker(state.made_by), link::is_selecting(state.made_by)});
  facts.current = context_.link.history.place_of(context_.shown.snapshot->info().generation);
  for (const ipc::HistoryBranch& branch : context_.link.history.branches()) {
    if (branch.generations.empty()) continue;
    const std::string fork = words_of_maker(context_.link.history.maker_of(branch.fork));
    std::vector<std::string> states;
    for (const ipc::ListedGeneration& state : branch.generations) states.push_back(words_of_maker(state.made_by));
    facts.branches.push_back({branch.number, fmt::format("{}, from {}", counted(states.size(), "state"), fork), some_of(states),
                              branch.generations.back().number});
  }
  return facts;
}

void HistoryTool::draw_tab(panels::PanelLayout& layout) {
  if (context_.link.history.stale()) layout.ask([this] { context_.link.history.ask(); });
  const StateFacts now = facts();
  const std::uint64_t generation = context_.shown.snapshot->info().generation;
  const bool follow = now.current && scrolled_to_ != generation;
  if (follow) scrolled_to_ = generation;
  if (const auto wanted = state_list(now, follow, layout)) layout.ask([this, state = *wanted] { go_to(state); });
}

void HistoryTool::go_to(std::uint64_t generation) {
  if (!context_.tools.allow_edit()) return;
  context_.tools.edit_begins();
  if (context_.shown.snapshot) stepping_from_ = context_.shown.snapshot->info().generation;
  context_.link.edits.go_to(generation);
}

// --- newer states ---

std::optional<std::vector<std::string>> HistoryTool::lost_by(const mesh::document::Edit& edit) const {
  const auto& shown = context_.shown.snapshot;
  if (!shown || mesh::document::kind_of(edit).group == mesh::document::EditGroup::step) return std::nullopt;
  const std::uint64_t generation = shown->info().generation;
  // The state that an undo leads to may not have arrived.
  const bool stepping = stepping_from_ == generation && (context_.link.edits.under_way() || !context_.link.document.up_to_date());
  if ((!shown->info().can_redo && !stepping) || may_give_up_of_ == generation) return std::nullopt;
  std::vector<std::string> lost;
  const link::FollowedHistory& history = context_.link.history;
  const auto place = stepping || !history.fresh() ? std::nullopt : history.place_of(generation);
  if (place) {
    bool changes_model = false;
    for (std::size_t i = *place + 1; i < history.states().size(); ++i) {
      const std::string& maker = history.states()[i].made_by;
      changes_model = changes_model || !link::is_selecting(maker);
      lost.push_back(words_of_maker(maker));
    }
    if (!changes_model) return std::nullopt;  // a selection is made again as fast as a question is answered
  }
  return lost;
}

bool HistoryTool::would_hold(const mesh::document::Edit& edit) const { return question_ || lost_by(edit); }

bool HistoryTool::hold(const mesh::document::Edit& edit, bool sends) {
  const auto& shown = context_.shown.snapshot;
  if (!shown || question_) return question_.has_value();
  if (std::holds_alternative<mesh::document::Undo>(edit) && shown->info().can_undo) stepping_from_ = shown->info().generation;
  const std::optional<std::vector<std::string>> lost = lost_by(edit);
  if (!lost) return false;
  held_ = sends ? std::optional(edit) : std::nullopt;
  ask(*lost);
  return true;
}

void HistoryTool::ask(const std::vector<std::string>& lost) {
  toolkit::set_cover(context_, toolkit::Cover::none);
  panels::Question& question = question_.emplace();
  question.title =
      lost.empty() ? "Set the newer states aside?" : fmt::format("Set {} newer state{} aside?", lost.size(), lost.size() == 1 ? "" : "s");
  question.text = "An edit takes the place of what was undone" + (lost.empty() ? std::string() : ": " + some_of(lost)) +
                  ". It is kept as a branch, which the tab History lists." + (held_ ? "" : " Then make the edit again.");
  question.choices = {{Reply::discard, "Go on", display::letter('G'), "G"}, {Reply::cancel, "Don't edit", display::Key::escape, "Esc"}};
  context_.trace.line(fmt::format("asks set aside {}", lost.size()));
  ++context_.changes;
}

void HistoryTool::reply(Reply reply) {
  question_.reset();
  std::optional<mesh::document::Edit> held = std::exchange(held_, std::nullopt);
  if (reply != Reply::discard || !context_.shown.snapshot) return;
  may_give_up_of_ = context_.shown.snapshot->info().generation;
  if (held) toolkit::send(context_, std::move(*held));
}

}  // namespace prismesh::kiosk::tools::history
