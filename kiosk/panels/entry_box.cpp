#include "kiosk/panels/entry_box.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

namespace prismesh::kiosk::panels {
namespace {

struct Recall {
  EntryState& entry;
  const std::vector<std::string>& entered;
};

/// Up and down go through what was entered before, and back to what was being typed.
void recall(ImGuiInputTextCallbackData& data, Recall& with) {
  EntryState& entry = with.entry;
  const std::size_t count = with.entered.size();
  if (count == 0) return;
  const std::string now(data.Buf, static_cast<std::size_t>(data.BufTextLen));
  if (data.EventKey == ImGuiKey_UpArrow) {
    if (!entry.recalled) entry.own = now;
    const std::size_t from = std::min(entry.recalled.value_or(count), count);
    if (from == 0) return;
    entry.recalled = from - 1;
  } else {
    if (!entry.recalled) return;
    if (++*entry.recalled >= count) entry.recalled.reset();
  }
  const std::string& text = entry.recalled ? with.entered[*entry.recalled] : entry.own;
  data.DeleteChars(0, data.BufTextLen);
  data.InsertChars(0, text.c_str());
}

int edited(ImGuiInputTextCallbackData* data) {
  Recall& with = *static_cast<Recall*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) {
    recall(*data, with);
  } else if (std::exchange(with.entry.caret_to_end, false)) {
    // A field that takes the keyboard by itself selects all of its text; the user continues the text instead.
    data->CursorPos = data->BufTextLen;
    data->ClearSelection();
  }
  return 0;
}

/// The field takes the keyboard whenever nothing else has the keyboard or the mouse.
void keep_keyboard(EntryState& entry, bool opened) {
  if (!opened && (ImGui::IsAnyItemActive() || ImGui::IsAnyMouseDown())) return;
  entry.caret_to_end = true;
  ImGui::SetKeyboardFocusHere();
}

}  // namespace

void begin_low(const char* name, const Place& room, float width) {
  ImGui::SetNextWindowPos(ImVec2(std::floor(room.x + room.width / 2), room.bottom() - kMargin), 0, ImVec2(0.5f, 1));
  ImGui::SetNextWindowSize(ImVec2(std::min(width, room.width - 2 * kMargin), 0));
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
}

void small_line(const std::string& text, unsigned colour) {
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

bool entry_field(const char* name, const std::vector<std::string>& earlier, bool opened, EntryState& entry) {
  keep_keyboard(entry, opened);
  ImGui::SetNextItemWidth(-1);
  Recall with{entry, earlier};
  return ImGui::InputText(name, &entry.text,
                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackAlways,
                          edited, &with);
}

}  // namespace prismesh::kiosk::panels
