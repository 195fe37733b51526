#include "kiosk/panel_arrangement.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/panels/document_panel.h"
#include "kiosk/panels/key_panels.h"
#include "kiosk/panels/message_panels.h"
#include "kiosk/panels/question_box.h"
#include "kiosk/panels/warnings_panel.h"
#include "kiosk/tool_list.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk {
namespace {

using panels::kGrid;
using panels::kMargin;
using panels::PanelLayout;
using toolkit::AsksQuestions;
using toolkit::Cover;
using toolkit::HasList;
using toolkit::HasStatus;
using toolkit::ToolContext;

panels::DocumentFacts document_facts(const ToolContext& context) {
  const ipc::SnapshotInfo& info = context.shown.snapshot->info();
  panels::DocumentFacts facts;
  facts.path = info.document;
  facts.nodes = info.nodes;
  facts.shells = info.counts.ok + info.counts.warn + info.counts.fail;  // the arrays hold removed ones too
  facts.parts = info.parts.size();
  facts.generation = info.generation;
  facts.length_unit = info.length_unit;
  facts.target_size = facts.largest_target_size = info.target_size;
  bool first = true;
  for (const ipc::SnapshotPart& part : info.parts) {
    if (part.shells == 0) continue;
    facts.target_size = first ? part.target_size : std::min(facts.target_size, part.target_size);
    facts.largest_target_size = first ? part.target_size : std::max(facts.largest_target_size, part.target_size);
    first = false;
  }
  if (const auto& state = context.link.document.state()) {
    facts.length_unit_guessed = state->length_unit_guessed;
    facts.target_size_guessed = state->target_size_guessed;
  }
  facts.changed = info.changed;
  return facts;
}

void left_panel(ToolContext& context, PanelLayout& layout) {
  if (context.open.left != nullptr) return context.open.left->draw_left(layout);
  panels::begin_left("Document", layout.picture);
  panels::document_head(document_facts(context));
  for (const auto& tool : context.tools.all()) tool->draw_document_section(layout);
  // What is pulled needs the room.
  if (!context.tools.pulling()) panels::history_section({context.link.document.history_bytes(), context.link.document.history_cap()});
  panels::document_foot();
  ImGui::End();
}

void right_panel(ToolContext& context, PanelLayout& layout) {
  const float width = panels::side_width(layout.picture), max_height = static_cast<float>(layout.picture.height) - 2 * kMargin;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(layout.picture.width) - kMargin - width, kMargin));
  std::size_t row_count = 0;
  float status = 0;
  for (const HasList* tool : context.tools.with<HasList>()) row_count += tool->list_rows();
  for (const HasStatus* tool : context.tools.with<HasStatus>())
    status += static_cast<float>(tool->status_height(static_cast<double>(width - 4 * kGrid)));
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::SetNextWindowSize(
      ImVec2(width, std::min(max_height, panels::on_grid(line * (static_cast<float>(row_count) + 7.0f) + 4 * kGrid + status))));
  ImGui::Begin("Quality and parts", nullptr, panels::kPanelFlags);
  for (HasStatus* tool : context.tools.with<HasStatus>()) tool->draw_status(layout);
  for (HasList* tool : context.tools.with<HasList>()) tool->draw_list(layout);
  ImGui::End();
}

void cover(ToolContext& context, std::span<const input::MouseBinding> mouse, PanelLayout& layout) {
  switch (context.open.cover) {
    case Cover::none: break;
    case Cover::help: panels::help_panel(key_bindings(), mouse, layout.picture); break;
    case Cover::menu: panels::menu_panel(key_bindings(), layout); break;
    case Cover::warnings:
      if (const auto& shown = context.shown.snapshot)
        panels::warnings_panel(context.link.document.warnings(), shown->info().document, layout.picture);
      break;
  }
}

void notice(ToolContext& context, PanelLayout& layout) {
  notices::Notices& notices = context.notices;
  if (notices.empty()) return;
  const input::Command list = command_of(EditorCommand::deck_warnings);
  const panels::NoticePlace place{context.shown.snapshot != nullptr, layout.bottom, input::binding_of(kDocumentKeys, list)};
  switch (panels::notice_panel({notices.front(), notices.count() - 1}, layout.picture, place)) {
    case panels::NoticeReply::none: break;
    case panels::NoticeReply::list_warnings: layout.ask(list); break;
    case panels::NoticeReply::read:
      layout.ask([&notices] {
        if (!notices.empty()) notices.read();
      });
      break;
  }
}

}  // namespace

void PanelArrangement::build(ToolContext& context, std::span<const input::MouseBinding> mouse, PanelLayout& layout) {
  const link::Connection& connection = context.link.connection;
  const link::ServerProgress& progress = connection.progress();
  const toolkit::OpenPanels& open = context.open;
  const bool document = context.shown.snapshot != nullptr;
  const AsksQuestions* asking = context.tools.asking();
  const std::string guidance = context.tools.guidance();
  layout.bottom = static_cast<double>(static_cast<float>(layout.picture.height) - kMargin);
  layout.top = static_cast<double>(guidance.empty() ? kMargin : kMargin + 3 * ImGui::GetFontSize());
  covered_width_ = 2.0 * static_cast<double>(panels::side_width(layout.picture) + kMargin);
  const bool covered = (open.cover != Cover::none && (open.cover != Cover::warnings || document)) || asking != nullptr ||
                       (open.dialog.owner != nullptr && open.dialog.owner->dialog_covers(open.dialog.kind));
  if (document && connection.connected() && !covered) {
    left_panel(context, layout);
    right_panel(context, layout);
    for (auto* tool : context.tools.with<toolkit::DrawsOverPicture>()) tool->draw_over_picture(layout);
  }
  const bool box = asking != nullptr || open.dialog.owner != nullptr;
  if (!connection.connected() || ((!document || !progress.words().empty()) && !box))
    panels::state_panel({connection.connected(), connection.socket().string(), progress.words(), progress.fraction()}, layout.picture);
  build_box(context, layout);
  cover(context, mouse, layout);
  if (!guidance.empty() && document) panels::guidance_panel(guidance, layout.picture);
  notice(context, layout);
}

/// The question, or else the dialog that is open.
void PanelArrangement::build_box(ToolContext& context, PanelLayout& layout) {
  AsksQuestions* asking = context.tools.asking();
  const toolkit::OpenPanels::Dialog dialog =
      context.link.connection.connected() && asking == nullptr ? context.open.dialog : toolkit::OpenPanels::Dialog{};
  const bool opened = std::exchange(shown_dialog_, dialog) != dialog;
  if (dialog.owner != nullptr) return dialog.owner->draw_dialog(dialog.kind, opened, layout);
  if (!context.link.connection.connected() || asking == nullptr) return;
  if (const auto reply = panels::question_box(*asking->question(), layout.picture))
    layout.ask([asking, chosen = *reply] { asking->reply(chosen); });
}

}  // namespace prismesh::kiosk
