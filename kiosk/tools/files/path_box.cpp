#include "kiosk/tools/files/path_box.h"

#include <filesystem>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::files {
namespace {

using panels::printable;

/// Tab: the text becomes what all offered entries begin with.
int complete(ImGuiInputTextCallbackData* data) {
  if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways) {
    // A field that takes the keyboard by itself selects all of its text; the user goes on with a path instead.
    bool& just_opened = *static_cast<bool*>(data->UserData);
    if (std::exchange(just_opened, false)) {
      data->CursorPos = data->BufTextLen;
      data->ClearSelection();
    }
    return 0;
  }
  const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
  const std::string longer = panels::common_beginning(panels::completions(typed, 10000));
  if (longer.size() > typed.size()) data->InsertChars(data->BufTextLen, longer.c_str() + typed.size());
  return 0;
}

const char* title_of(PathDialog dialog) {
  return dialog == PathDialog::open ? "Open a deck" : dialog == PathDialog::save_copy ? "Save a copy" : "Save as another deck";
}

/// Completions, and what follows from entering the path.
void notes(const PathFacts& facts, PathEntry& entry) {
  const bool opens = facts.dialog == PathDialog::open;
  ImGui::PushFont(panels::small_font());
  if (entry.offered_for != entry.typed) {
    entry.offered = panels::completions(entry.typed, 8);
    entry.offered_for = entry.typed;
  }
  for (const std::string& offered : entry.offered)
    if (ImGui::Selectable(printable(offered).c_str())) entry.typed = offered;
  ImGui::TextDisabled("Tab completes, Enter %s, Esc closes", opens ? "opens" : "saves");
  if (!facts.deck.empty() && !opens) {
    const std::string name = std::filesystem::path(facts.deck).filename().string();
    panels::elided_text(
        printable(facts.dialog == PathDialog::save_copy ? "You go on with " + name + "."
                                                        : "You go on with the new deck. " + name + " stays on disk as it was last saved."),
        ImGui::GetContentRegionAvail().x);
  }
  ImGui::PopFont();
}

}  // namespace

std::optional<std::string> path_box(const PathFacts& facts, const panels::Place& room, PathEntry& entry) {
  panels::begin_centred("Path", room, ImGui::GetFontSize() * 44);
  ImGui::PushFont(panels::title_font());
  ImGui::TextUnformatted(title_of(facts.dialog));
  ImGui::PopFont();
  if (facts.opened) {
    const std::filesystem::path current(facts.deck);
    entry.typed = facts.dialog != PathDialog::open || facts.deck.empty() ? current.string() : (current.parent_path() / "").string();
    entry.caret_to_end = true;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  const bool entered =
      ImGui::InputText("##path", &entry.typed,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways,
                       complete, &entry.caret_to_end);
  notes(facts, entry);
  ImGui::End();
  return entered && !entry.typed.empty() ? std::optional(entry.typed) : std::nullopt;
}

}  // namespace prismesh::kiosk::tools::files
