#include "kiosk/tools/files/path_box.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/counted.h"
#include "kiosk/panels/entry_box.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::tools::files {
namespace {

using panels::kGrid;
using panels::printable;

constexpr float kRowsInSight = 14;

struct Keys {
  PathEntry& entry;
  std::size_t rows = 0;
};

/// Tab: the text becomes what all entries that begin with it share. Up and Down choose a row.
int by_key(ImGuiInputTextCallbackData* data) {
  auto& [entry, rows] = *static_cast<Keys*>(data->UserData);
  switch (data->EventFlag) {
    case ImGuiInputTextFlags_CallbackAlways:
      // A field that takes the keyboard by itself selects all of its text; the user goes on with a path instead.
      if (std::exchange(entry.caret_to_end, false)) {
        data->CursorPos = data->BufTextLen;
        data->ClearSelection();
      }
      break;
    case ImGuiInputTextFlags_CallbackCompletion: {
      const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
      const std::string longer = panels::common_beginning(panels::completions(typed, 10000));
      if (longer.size() > typed.size()) data->InsertChars(data->BufTextLen, longer.c_str() + typed.size());
      break;
    }
    case ImGuiInputTextFlags_CallbackHistory:
      if (rows == 0) break;
      entry.chosen_by_key = true;
      if (data->EventKey == ImGuiKey_DownArrow)
        entry.chosen = entry.chosen ? std::min(*entry.chosen + 1, rows - 1) : 0;
      else if (entry.chosen)
        entry.chosen = *entry.chosen > 0 ? std::optional(*entry.chosen - 1) : std::nullopt;
      break;
    default: {  // edited
      entry.chosen.reset();
      const std::string_view typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
      if (const std::size_t before = before_absolute_path(typed); before > 0) data->DeleteChars(0, static_cast<int>(before));
      break;
    }
  }
  return 0;
}

const char* title_of(PathDialog dialog) {
  return dialog == PathDialog::open ? "Open a deck" : dialog == PathDialog::save_copy ? "Save a copy" : "Save as another deck";
}

std::string begun_for(const PathFacts& facts) {
  if (!facts.tried.empty()) return facts.tried;
  const std::filesystem::path current(facts.deck);
  if (facts.dialog == PathDialog::save_copy) return copy_name(facts.deck);
  if (facts.dialog != PathDialog::open) return current.string();
  if (!facts.deck.empty()) return (current.parent_path() / "").string();
  if (!facts.recent.empty()) return (std::filesystem::path(facts.recent.front().path).parent_path() / "").string();
  std::error_code ignored;
  return (std::filesystem::current_path(ignored) / "").string();
}

/// The rows as they stand in the list: recent decks and models of the store while nothing is typed, the folder above, the folder's entries.
std::vector<BrowseRow> rows_of(const PathFacts& facts, const PathEntry& entry) {
  std::vector<BrowseRow> rows;
  const bool begins = facts.dialog == PathDialog::open && entry.typed == entry.begun;
  if (begins)
    for (const RecentDeck& deck : facts.recent) {
      const std::filesystem::path path(deck.path);
      rows.push_back({deck.path, path.filename().string() + "   " + path.parent_path().string(),
                      fmt::format("{}, {}", counted(deck.shells, "shell"), counted(deck.parts, "part")), false});
    }
  if (begins) rows.insert(rows.end(), facts.shelf.begin(), facts.shelf.end());
  const std::filesystem::path folder = std::filesystem::path(entry.typed.substr(0, entry.typed.rfind('/') + 1)).parent_path();
  if (folder.has_parent_path() && folder != folder.parent_path()) rows.push_back({(folder.parent_path() / "").string(), "../", "", true});
  rows.insert(rows.end(), entry.browsed.rows.begin(), entry.browsed.rows.end());
  return rows;
}

/// True: the row was clicked.
bool draw_row(const BrowseRow& row, std::size_t number, bool chosen, panels::PanelLayout& layout) {
  const float left = ImGui::GetCursorPosX(), right = ImGui::GetWindowContentRegionMax().x;
  ImGui::PushID(static_cast<int>(number));
  const bool clicked = ImGui::Selectable("##row", chosen);
  ImGui::PopID();
  panels::note_item(layout, "file " + printable(row.path), chosen ? "chosen" : "");
  const float detail = ImGui::CalcTextSize(row.detail.c_str()).x;
  ImGui::SameLine();
  ImGui::SetCursorPosX(left);
  if (row.folder) ImGui::PushStyleColor(ImGuiCol_Text, panels::kInformationColour);
  panels::elided_text(printable(row.words), right - left - detail - 2 * kGrid);
  if (row.folder) ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - detail);
  ImGui::TextDisabled("%s", row.detail.c_str());
  return clicked;
}

/// What the folder holds, what is wrong, what the keys do.
void foot(const PathFacts& facts, PathEntry& entry, panels::PanelLayout& layout) {
  const bool opens = facts.dialog == PathDialog::open;
  const Browsed& browsed = entry.browsed;
  if (!facts.problem.empty() && entry.typed == entry.begun) {
    panels::small_line(panels::printable_lines(facts.problem), panels::kFailColour);
    panels::note_item(layout, "open problem", printable(facts.problem));
  }
  for (std::size_t i = 0; i < facts.pairing.size(); ++i) {
    if (i == 0)
      ImGui::TextWrapped("%s", printable(facts.pairing[i]).c_str());
    else
      panels::small_line(printable(facts.pairing[i]), panels::kInformationColour);
    panels::note_item(layout, "pairing " + std::to_string(i), printable(facts.pairing[i]));
  }
  if (!browsed.problem.empty())
    panels::small_line(printable(browsed.problem), panels::kWarnColour);
  else
    panels::small_line(fmt::format("{}, {}{}{}", counted(browsed.folders, "folder"), counted(browsed.decks, "deck"),
                                   browsed.others > 0 ? ", " + counted(browsed.others, "other file") : "", browsed.cut ? ", and more" : ""),
                       panels::kFaintInk);
  ImGui::Checkbox("all files", &entry.all);
  panels::note_item(layout, "all files", entry.all ? "on" : "off");
  panels::small_line(fmt::format("Up and Down choose, Tab completes, Enter {}, Esc closes", opens ? "opens" : "saves"), panels::kFaintInk);
  if (facts.deck.empty() || opens) return;
  const std::string name = printable(std::filesystem::path(facts.deck).filename().string());
  panels::small_line(facts.dialog == PathDialog::save_copy
                         ? "You go on with " + name + "."
                         : "You go on with the new deck. " + name + " stays on disk as it was last saved.",
                     panels::kFaintInk);
}

/// At the right. True: the one that opens or saves was pressed; `entry` says of the other.
bool buttons(const PathFacts& facts, PathEntry& entry, panels::PanelLayout& layout) {
  const char* const does = facts.dialog == PathDialog::open ? "Open" : "Save";
  const float width = 6 * ImGui::GetFontSize();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - 2 * width - kGrid);
  const bool pressed = ImGui::Button(does, ImVec2(width, 0));
  panels::note_item(layout, "path ok", does);
  ImGui::SameLine(0, kGrid);
  if (ImGui::Button("Cancel", ImVec2(width, 0))) entry.cancelled = true;
  panels::note_item(layout, "path cancel", "");
  return pressed;
}

}  // namespace

std::optional<std::string> path_box(const PathFacts& facts, PathEntry& entry, panels::PanelLayout& layout) {
  const panels::Place room = layout.view();
  panels::begin_centred("Path", room, ImGui::GetFontSize() * 52);
  ImGui::PushFont(panels::title_font());
  ImGui::TextUnformatted(title_of(facts.dialog));
  ImGui::PopFont();
  if (facts.opened) {
    const bool all = entry.all;
    entry = PathEntry{};
    entry.all = all;
    entry.typed = entry.begun = begun_for(facts);
  }
  if (facts.opened || (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown())) {
    entry.caret_to_end = true;
    ImGui::SetKeyboardFocusHere();
  }
  if (entry.browsed_for != entry.typed || entry.browsed_all != entry.all) {
    entry.browsed = browse(entry.typed, entry.all);
    entry.browsed_for = entry.typed;
    entry.browsed_all = entry.all;
  }
  const std::vector<BrowseRow> rows = rows_of(facts, entry);
  ImGui::SetNextItemWidth(-1);
  Keys keys{entry, rows.size()};
  const bool enter =
      ImGui::InputText("##path", &entry.typed,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways |
                           ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackEdit,
                       by_key, &keys);
  panels::note_item(layout, "path", printable(entry.typed));
  std::size_t taken = enter && entry.chosen ? *entry.chosen : rows.size();  // none
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float most = std::max(3 * line, room.height - 10 * line - 6 * kGrid);
  ImGui::BeginChild("files", ImVec2(0, std::min(most, kRowsInSight * line)));
  // A folder may hold thousands.
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()), line);
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto row = static_cast<std::size_t>(i);
      if (draw_row(rows[row], row, entry.chosen == row, layout)) taken = row;
    }
  if (entry.chosen && std::exchange(entry.chosen_by_key, false))
    ImGui::SetScrollFromPosY(ImGui::GetCursorStartPos().y + (static_cast<float>(*entry.chosen) + 0.5F) * line - ImGui::GetScrollY(), 0.5F);
  ImGui::EndChild();
  foot(facts, entry, layout);
  const bool pressed = buttons(facts, entry, layout);
  ImGui::End();
  if (pressed) {
    if (entry.chosen && *entry.chosen < rows.size())
      taken = *entry.chosen;
    else if (!entry.typed.empty())
      return entry.typed;
  }
  if (taken >= rows.size()) return enter && !entry.typed.empty() ? std::optional(entry.typed) : std::nullopt;
  const BrowseRow& row = rows[taken];
  // A folder is gone into; a file is opened, or its name is gone on with.
  entry.chosen.reset();
  if (facts.dialog == PathDialog::open && !row.folder) return row.path;
  entry.typed = row.path;
  entry.caret_to_end = true;
  return std::nullopt;
}

}  // namespace prismesh::kiosk::tools::files
