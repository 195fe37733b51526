#include "kiosk/panel_arrangement.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <imgui.h>

#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/panels/document_panel.h"
#include "kiosk/panels/frame_panels.h"
#include "kiosk/panels/hand_marks.h"
#include "kiosk/panels/key_panels.h"
#include "kiosk/panels/message_panels.h"
#include "kiosk/panels/question_box.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/warnings_panel.h"
#include "kiosk/tool_list.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/files/files_tool.h"
#include "kiosk/tools/find/find_tool.h"

namespace prismesh::kiosk {
namespace {

using panels::kGrid;
using panels::kMargin;
using panels::PanelLayout;
using toolkit::AsksQuestions;
using toolkit::Cover;
using toolkit::ToolContext;

/// Where decks lie is no matter of an exhibition's visitors.
std::string shown_path(const ToolContext& context, const std::filesystem::path& path) {
  return context.options.exhibition ? path.filename().string() : path.string();
}

panels::DocumentFacts document_facts(const ToolContext& context) {
  const ipc::SnapshotInfo& info = context.shown.snapshot->info();
  panels::DocumentFacts facts;
  facts.path = shown_path(context, info.document);
  facts.nodes = info.nodes;
  facts.shells = info.counts.ok + info.counts.warn + info.counts.fail;  // the arrays hold removed ones too
  facts.parts = info.parts.size();
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
  return facts;
}

/// The commands that the bar has buttons for.
panels::BarKeys bar_keys() {
  const auto of_editor = [](EditorCommand command) -> const input::KeyBinding& {
    return input::binding_of(key_bindings(), command_of(command));
  };
  return {of_editor(EditorCommand::undo), of_editor(EditorCommand::redo), input::binding_of(key_bindings(), tools::files::save_command()),
          &input::binding_of(key_bindings(), tools::find::find_command()), of_editor(EditorCommand::help)};
}

void bar(ToolContext& context, PanelLayout& layout) {
  panels::BarFacts facts;
  if (const auto& shown = context.shown.snapshot) {
    const std::filesystem::path path = shown->info().document;
    facts.deck = path.filename().string();
    facts.path = shown_path(context, path);
    facts.changed = shown->info().changed;
    facts.can_undo = shown->info().can_undo;
    facts.can_redo = shown->info().can_redo;
  }
  const auto more = [&](input::Menu menu) {
    for (auto* tool : context.tools.with<toolkit::HasMenuEntries>()) tool->draw_menu_entries(menu, layout);
  };
  panels::bar_panel(facts, bar_keys(), key_bindings(), more, layout);
}

void rail(ToolContext& context, PanelLayout& layout) {
  std::vector<toolkit::RailEntry> entries;
  for (const auto* tool : context.tools.with<toolkit::InRail>())
    for (const toolkit::RailEntry& entry : tool->rail()) entries.push_back(entry);
  std::ranges::sort(entries, {}, &toolkit::RailEntry::place);
  std::vector<panels::RailButton> buttons;
  buttons.reserve(entries.size());
  for (const toolkit::RailEntry& entry : entries) buttons.push_back({entry.label, entry.key, entry.on});
  panels::rail_panel(buttons, layout);
}

void push_padding(float tab) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(tab, kGrid / 2));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemInnerSpacing, ImVec2(2, kGrid / 2));
}

/// Pushes a padding with which all tabs are seen side by side, if they can be.
float push_tab_padding(const ToolContext& context) {
  float words = ImGui::CalcTextSize("Model").x;
  float count = 1;
  for (const auto* tool : context.tools.with<toolkit::HasTab>()) words += ImGui::CalcTextSize(tool->tab()).x, ++count;
  const float room = ImGui::GetContentRegionAvail().x - words - 3 * count;
  const float padding = std::clamp(std::floor(room / (2 * count)), 2.0F, kGrid);
  push_padding(padding);
  return padding;
}

toolkit::Tool* in_hand(const ToolContext& context) { return context.open.in_hand != nullptr ? context.open.in_hand : context.open.usual; }

void options(ToolContext& context, PanelLayout& layout) {
  const panels::Place& place = layout.places.options;
  if (place.empty()) return;
  const float padding = std::floor((place.height - ImGui::GetFrameHeight()) / 2);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kGrid, padding));
  panels::begin_docked("Options", place);
  ImGui::PopStyleVar();
  if (auto* tool = dynamic_cast<toolkit::HasOptions*>(in_hand(context)); tool != nullptr && context.shown.snapshot) {
    panels::OptionRow row(layout);
    tool->draw_options(row);
  }
  ImGui::End();
}

panels::StatusFacts status_facts(const ToolContext& context) {
  panels::StatusFacts facts;
  if (const auto& shown = context.shown.snapshot) {
    const ipc::SnapshotInfo& info = shown->info();
    if (const auto* tool = dynamic_cast<const toolkit::HasOptions*>(in_hand(context))) facts.setting = tool->setting_words();
    for (const auto* tool : context.tools.with<toolkit::TellsLive>())
      if (facts.pointed.empty()) facts.pointed = tool->live_words();
    if (facts.pointed.empty()) facts.pointed = context.link.notices.result();
    if (facts.pointed.empty()) facts.pointed = context.pointed.words;
    if (info.selected_nodes > 0)
      facts.selection = panels::grouped(info.selected_nodes) + (info.selected_nodes == 1 ? " node selected" : " nodes selected");
    const bool guessed = context.link.document.state() && context.link.document.state()->length_unit_guessed;
    facts.unit = info.length_unit + (guessed ? "?" : "");
  }
  const toolkit::PictureView& view = context.view;
  if (view.eyes) {
    facts.lights.push_back(
        {view.eyes->in_depth ? "eyes" : "flat", view.eyes->eyes, view.eyes->condition != toolkit::EyesFacts::Condition::trouble});
    if (!view.eyes->mask.empty())
      facts.lights.push_back({"mask", view.eyes->mask, view.eyes->condition != toolkit::EyesFacts::Condition::trouble});
  }
  for (const auto* tool : context.tools.with<toolkit::HasLight>())
    if (const auto light = tool->light()) facts.lights.push_back({light->name, light->state, light->good});
  const bool connected = context.link.connection.connected();
  facts.lights.push_back({"model server", connected ? "connected" : "not running", connected});
  return facts;
}

/// What the pointer would take, or how far it has pulled something.
void hand(const ToolContext& context, PanelLayout& layout) {
  if (!context.hand.at) return;
  for (const auto* tool : context.tools.with<toolkit::TellsLive>())
    if (const std::string value = tool->value_at_hand(); !value.empty()) return panels::words_at_hand(value, *context.hand.at, layout);
  if (context.hand.on == input::Under::picture) return;
  const toolkit::HandlePart part = context.tools.part_at(*context.hand.at);
  if (part.does.empty()) return;
  panels::highlight_part(part.lines, layout);
  panels::words_at_hand(part.does, *context.hand.at, layout);
}

void cover(ToolContext& context, std::span<const input::MouseBinding> mouse, PanelLayout& layout) {
  switch (context.open.cover) {
    case Cover::none: break;
    case Cover::help: panels::help_panel(key_bindings(), mouse, panels::whole(layout.picture)); break;
    case Cover::menu: panels::menu_panel(key_bindings(), layout); break;
    case Cover::warnings:
      if (const auto& shown = context.shown.snapshot)
        panels::warnings_panel(context.link.document.warnings(), shown->info().document, panels::whole(layout.picture));
      break;
  }
}

void notice(ToolContext& context, PanelLayout& layout) {
  notices::Notices& notices = context.notices;
  if (notices.empty()) return;
  const input::Command list = command_of(EditorCommand::deck_warnings);
  const panels::NoticePlace place{layout.bottom, input::binding_of(kDocumentKeys, list)};
  switch (panels::notice_panel({notices.front(), notices.count() - 1}, layout.view(), place)) {
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
  const bool document = context.shown.snapshot != nullptr;
  std::string guidance = context.tools.guidance();
  if (guidance.empty()) guidance = context.options.title;
  layout.places = panels::place_panels(layout.picture, ImGui::GetFontSize(), kept_.now());
  const panels::Place view = layout.view();
  layout.bottom = static_cast<double>(view.bottom() - kMargin);
  layout.top = static_cast<double>(view.y + (guidance.empty() ? kMargin : kMargin + 3 * ImGui::GetFontSize()));
  layout.items.push_back({"view", "", view});
  bar(context, layout);
  rail(context, layout);
  options(context, layout);
  build_dock(context, layout);
  panels::status_panel(status_facts(context), layout);
  follow_borders(layout);
  build_menu(context, layout);
  const bool box = context.tools.asking() != nullptr || context.open.dialog.owner != nullptr;
  if (!connection.connected() || ((!document || !progress.words().empty()) && !box))
    panels::state_panel({connection.connected(), connection.socket().string(), progress.words(), progress.fraction()},
                        input::binding_of(key_bindings(), tools::files::open_command()), layout);
  if (connection.connected())
    for (auto* tool : context.tools.with<toolkit::DrawsOverPicture>()) tool->draw_over_picture(layout);
  if (document && connection.connected()) hand(context, layout);
  build_box(context, layout);
  cover(context, mouse, layout);
  if (!guidance.empty() && document) {
    panels::guidance_panel(guidance, view);
    layout.items.push_back({"guidance", guidance, view});
  }
  notice(context, layout);
}

/// Tabs above, the tool in hand below.
void PanelArrangement::build_dock(ToolContext& context, PanelLayout& layout) {
  const panels::Places& places = layout.places;
  if (places.dock.empty()) return;
  const bool document = context.shown.snapshot != nullptr;
  panels::begin_docked("Dock", places.upper);
  const float tabs = push_tab_padding(context);
  std::string tab_shown;
  if (ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyScroll)) {
    const auto tab = [&](const char* name, const std::function<void()>& draw) {
      const bool kept = !tab_brought_ && kept_.now().tab == name;
      const bool shown = ImGui::BeginTabItem(name, nullptr, kept ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None);
      panels::note_item(layout, std::string("tab ") + name, shown ? "on" : "off");
      if (!shown) return;
      tab_shown = name;
      ImGui::PopStyleVar(2);
      ImGui::BeginChild(name);
      if (document) draw();
      ImGui::EndChild();
      push_padding(tabs);
      ImGui::EndTabItem();
    };
    for (auto* tool : context.tools.with<toolkit::HasTab>()) tab(tool->tab(), [&] { tool->draw_tab(layout); });
    tab("Model", [&] {
      panels::model_facts(document_facts(context));
      panels::history_facts({context.link.document.history_bytes(), context.link.document.history_cap()});
      if (const render::VideoMemory& memory = context.video_memory; memory.limit > 0)
        panels::video_memory_facts({render::megabytes_of(memory), render::in_words(memory.given_up)});
    });
    ImGui::EndTabBar();
  }
  keep_tab(tab_shown);
  ImGui::PopStyleVar(2);
  ImGui::End();
  panels::begin_docked("In hand", places.lower);
  ImGui::BeginChild("panel");
  if (document) {
    for (auto* tool : context.tools.with<toolkit::HasStatus>()) tool->draw_status(layout);
    if (toolkit::Tool* tool = in_hand(context); tool != nullptr) tool->draw_panel(layout);
  }
  ImGui::EndChild();
  ImGui::End();
}

/// What can be done with what is under the pointer, and where the pointer was when it was asked for.
void PanelArrangement::build_menu(ToolContext& context, PanelLayout& layout) {
  constexpr const char* kName = "at pointer";
  if (const auto asked = std::exchange(context.open.menu_at, std::nullopt)) {
    menu_at_ = asked;
    ImGui::OpenPopup(kName);
    ImGui::SetNextWindowPos(ImVec2(static_cast<float>(asked->x()) + 1, static_cast<float>(asked->y()) + 1));
  }
  if (!menu_at_) return;
  if (!ImGui::BeginPopup(kName)) return menu_at_.reset();
  const bool something = !context.pointed.words.empty();
  ImGui::TextDisabled("%s", something ? context.pointed.words.c_str() : "nothing is under the pointer");
  panels::note_item(layout, "menu at pointer", context.pointed.words);
  std::optional<input::Menu> menu;
  for (const input::KeyBinding& binding : key_bindings()) {
    if (!binding.at_pointer()) continue;
    if (menu != binding.menu) ImGui::Separator();
    menu = binding.menu;
    if (ImGui::MenuItem(std::string(binding.meaning).c_str(), std::string(binding.label).c_str(), false, something))
      layout.actions.emplace_back(
          [run = layout.run_command_at, command = binding.command, at = *menu_at_] { run(command, at.x(), at.y()); });
    panels::note_item(layout, "entry " + std::string(binding.meaning), "");
  }
  ImGui::EndPopup();
}

/// A tab that was kept is shown a layout after it was asked for.
void PanelArrangement::keep_tab(const std::string& shown) {
  panels::Arrangement wanted = kept_.now();
  if (!tab_brought_ && !wanted.tab.empty() && shown != wanted.tab && tab_tries_++ < 4) return;
  tab_brought_ = true;
  if (shown.empty() || shown == wanted.tab) return;
  wanted.tab = shown;
  kept_.set(wanted);
}

void PanelArrangement::follow_borders(PanelLayout& layout) {
  if (const auto wanted = panels::borders(kept_.now(), layout))
    kept_.set(*wanted);
  else if (!ImGui::IsMouseDown(ImGuiMouseButton_Left))
    kept_.keep();
}

/// The question, or else the dialog that is open.
void PanelArrangement::build_box(ToolContext& context, PanelLayout& layout) {
  AsksQuestions* asking = context.tools.asking();
  const toolkit::OpenPanels::Dialog dialog =
      context.link.connection.connected() && asking == nullptr ? context.open.dialog : toolkit::OpenPanels::Dialog{};
  const bool opened = std::exchange(shown_dialog_, dialog) != dialog;
  if (dialog.owner != nullptr) return dialog.owner->draw_dialog(dialog.kind, opened, layout);
  if (!context.link.connection.connected() || asking == nullptr) return;
  if (const auto reply = panels::question_box(*asking->question(), layout.view()))
    layout.ask([asking, chosen = *reply] { asking->reply(chosen); });
}

}  // namespace prismesh::kiosk
