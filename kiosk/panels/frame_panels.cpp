#include "kiosk/panels/frame_panels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::panels {
namespace {

using input::KeyBinding;

float text_width(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

/// Pushes a padding that makes a frame as high as `place` less a margin.
void push_frame_height(const Place& place) {
  const float padding = std::max(1.0F, std::floor((place.height - kGrid - ImGui::GetFontSize()) / 2));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(kGrid, padding));
}

void menus(std::span<const KeyBinding> all, const std::function<void(input::Menu)>& more, PanelLayout& layout) {
  float wanted = 0;
  for (const std::string_view name : input::kMenuNames) wanted += text_width(std::string(name)) + 2 * kGrid;
  // Where the names would take more than half of the bar they go into one menu.
  const bool one = wanted > 0.5F * layout.places.bar.width;
  if (one && !ImGui::BeginMenu("Menu")) return note_item(layout, "menu Menu", "");
  for (std::size_t m = 0; m < input::kMenuNames.size(); ++m) {
    const bool open = ImGui::BeginMenu(input::kMenuNames[m].data());
    if (!open) note_item(layout, "menu " + std::string(input::kMenuNames[m]), "");
    if (!open) continue;
    std::string_view owner;
    for (const KeyBinding& binding : all) {
      if (static_cast<std::size_t>(binding.menu) != m) continue;
      // What one tool does stands together.
      if (!owner.empty() && owner != binding.command.owner) ImGui::Separator();
      owner = binding.command.owner;
      menu_row(binding, layout);
    }
    more(static_cast<input::Menu>(m));
    ImGui::EndMenu();
  }
  if (one) ImGui::EndMenu();
}

/// The deck's name, and whether it is saved; a click saves it.
void deck_and_state(const BarFacts& facts, const BarKeys& keys, const Place& room, PanelLayout& layout) {
  const std::string state = facts.changed ? "\u25cf modified" : "saved";
  const float state_width = text_width(state) + 2 * ImGui::GetStyle().FramePadding.x;
  const float name_width = room.width - state_width - kGrid;
  const float top = std::floor((room.height - ImGui::GetFrameHeight()) / 2);
  if (facts.deck.empty() || name_width < 3 * ImGui::GetFontSize()) return;
  // A bar lays text out on the base line of what stood before it.
  const float base = ImGui::GetCurrentWindow()->DC.CurrLineTextBaseOffset;
  ImGui::SetCursorPos(ImVec2(room.x, std::floor((room.height - ImGui::GetTextLineHeight()) / 2) - base));
  elided_text(printable(facts.deck), name_width);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(facts.path).c_str());
  note_item(layout, "deck", printable(facts.deck));
  ImGui::SetCursorPosY(top);
  if (!facts.changed) ImGui::BeginDisabled();
  if (facts.changed) ImGui::PushStyleColor(ImGuiCol_Text, kWarnColour);
  if (ImGui::Button(state.c_str())) layout.ask(keys.save.command);
  if (facts.changed) ImGui::PopStyleColor();
  if (!facts.changed) ImGui::EndDisabled();
  if (facts.changed) hint(keys.save);
  note_item(layout, "save", facts.changed ? "modified" : "saved");
}

/// Three dots in the middle: the border can be dragged.
void draw_grip(ImDrawList& list, const Place& place) {
  const bool upright = place.height > place.width;
  const ImVec2 middle(place.x + place.width / 2, place.y + place.height / 2);
  for (const float at : {-0.6F * kGrid, 0.0F, 0.6F * kGrid})
    list.AddCircleFilled(upright ? ImVec2(middle.x, middle.y + at) : ImVec2(middle.x + at, middle.y), 0.2F * kGrid, kFaintInk);
}

}  // namespace

void menu_row(const KeyBinding& binding, PanelLayout& layout) {
  if (ImGui::MenuItem(std::string(binding.meaning).c_str(), std::string(binding.label).c_str())) layout.ask(binding.command);
  note_item(layout, "entry " + std::string(binding.meaning), "");
}

void bar_panel(const BarFacts& facts, const BarKeys& keys, std::span<const KeyBinding> all, const std::function<void(input::Menu)>& more,
               PanelLayout& layout) {
  const Place& place = layout.places.bar;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  push_frame_height({0, 0, 0, place.height + kGrid});
  begin_docked("Bar", place, ImGuiWindowFlags_MenuBar);
  const bool begun = ImGui::BeginMenuBar();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kGrid, kGrid));  // of menus and hints
  if (begun) {
    menus(all, more, layout);
    push_frame_height(place);
    const auto centre = [&](float height) { ImGui::SetCursorPosY(std::floor((place.height - height) / 2)); };
    ImGui::Dummy(ImVec2(kGrid / 2, 0));
    for (const bool undo : {true, false}) {
      const KeyBinding& key = undo ? keys.undo : keys.redo;
      const bool can = undo ? facts.can_undo : facts.can_redo;
      centre(ImGui::GetFrameHeight());
      if (!can) ImGui::BeginDisabled();
      if (ImGui::Button(undo ? "\u21b6" : "\u21b7", ImVec2(1.3F * ImGui::GetFrameHeight(), 0))) layout.ask(key.command);
      if (!can) ImGui::EndDisabled();
      if (can) hint(key);
      note_item(layout, undo ? "undo" : "redo", can ? "can" : "can't");
    }
    // From the right: help, search. Between them and the menus the deck's name has what is left.
    const float help = ImGui::GetFrameHeight(), left = ImGui::GetCursorPosX() + kGrid;
    const std::string short_words(keys.find != nullptr ? keys.find->label : ""), find_words = short_words + "   find a command or an id";
    const float padding = 2 * ImGui::GetStyle().FramePadding.x, em = ImGui::GetFontSize();
    float right = place.width - kGrid;
    const bool has_help = right - help > left;
    if (has_help) right -= help;
    const bool is_long = right - kGrid - text_width(find_words) - 2 * padding - left > 20 * em;
    const float find = is_long ? text_width(find_words) + 2 * padding : text_width(short_words) + padding;
    const bool has_find = keys.find != nullptr && right - kGrid - find > left;
    if (has_find) right -= kGrid + find;
    deck_and_state(facts, keys, {left, 0, right - kGrid - left, place.height}, layout);
    if (has_find) {
      ImGui::SetCursorPosX(right);
      centre(ImGui::GetFrameHeight());
      ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(is_long ? 0.1F : 0.5F, 0.5F));
      if (ImGui::Button(is_long ? find_words.c_str() : short_words.c_str(), ImVec2(find, 0))) layout.ask(keys.find->command);
      ImGui::PopStyleVar();
      hint(*keys.find);
      note_item(layout, "find", "");
    }
    if (has_help) {
      ImGui::SetCursorPosX(place.width - kGrid - help);
      centre(ImGui::GetFrameHeight());
      if (ImGui::Button("?", ImVec2(help, 0))) layout.ask(keys.help.command);
      hint(keys.help);
      note_item(layout, "help", "");
    }
    ImGui::PopStyleVar();
    ImGui::EndMenuBar();
  }
  ImGui::PopStyleVar();
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void rail_panel(std::span<const RailButton> buttons, PanelLayout& layout) {
  const Place& place = layout.places.rail;
  if (place.empty()) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kGrid / 2, kGrid / 2));
  begin_docked("Rail", place, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  const float width = place.width - kGrid, height = std::round(ImGui::GetFontSize() * 2.1F);
  for (const RailButton& button : buttons) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(button.label);
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(button.on ? ImGuiCol_ButtonActive : ImGuiCol_ChildBg));
    if (ImGui::Button("##tool", ImVec2(width, height))) layout.ask(button.key->command);
    ImGui::PopStyleColor();
    ImGui::PopID();
    hint(*button.key);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (button.on) list.AddRectFilled(at, ImVec2(at.x + kGrid / 2, at.y + height), kActiveColour);
    const float text = at.y + (height - ImGui::GetFontSize()) / 2;
    if (layout.places.short_rail) {
      list.AddText(ImVec2(at.x + (width - ImGui::CalcTextSize(button.label, button.label + 1).x) / 2, text), kInk, button.label,
                   button.label + 1);
    } else {
      list.AddText(ImVec2(at.x + kGrid, text), kInk, button.label);
      ImFont& small = *small_font();
      const std::string key(button.key->label);
      const float label_end = kGrid + ImGui::CalcTextSize(button.label).x + kGrid;
      const float key_width = small.CalcTextSizeA(small.FontSize, 1e9F, 0, key.c_str()).x;
      if (label_end + key_width <= width)
        list.AddText(&small, small.FontSize, ImVec2(at.x + width - key_width - kGrid / 2, text + ImGui::GetFontSize() - small.FontSize),
                     kFaintInk, key.c_str());
    }
    note_item(layout, std::string("rail ") + button.label, button.on ? "on" : "off");
  }
  ImGui::End();
}

void status_panel(const StatusFacts& facts, PanelLayout& layout) {
  const Place& place = layout.places.status;
  const float padding = std::max(0.0F, std::floor((place.height - ImGui::GetFontSize()) / 2));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(2 * kGrid, padding));
  begin_docked("Status", place);
  ImGui::PopStyleVar();
  const float signal = ImGui::GetFontSize() * 0.65F, gap = 2 * kGrid;
  float right = ImGui::GetWindowContentRegionMax().x;
  const float left = ImGui::GetCursorPosX(), line = ImGui::GetCursorPosY();
  // From the right: lights, unit, selection.
  for (auto light = facts.lights.rbegin(); light != facts.lights.rend(); ++light) {
    right -= text_width(light->name) + signal + kGrid;
    ImGui::SetCursorPos(ImVec2(right, line));
    ImGui::BeginGroup();
    draw_signal(light->good ? Signal::ok : Signal::warn, signal);
    ImGui::SameLine(0, kGrid / 2);
    ImGui::TextUnformatted(light->name.c_str());
    ImGui::EndGroup();
    if (ImGui::IsItemHovered() && !light->state.empty()) ImGui::SetTooltip("%s", printable(light->state).c_str());
    note_item(layout, "status " + light->name, light->state);
    right -= gap;
  }
  const auto at_right = [&](const char* name, const std::string& text) {
    if (text.empty() || right - text_width(text) < left) return;
    right -= text_width(text);
    ImGui::SetCursorPos(ImVec2(right, line));
    ImGui::TextUnformatted(text.c_str());
    note_item(layout, name, text);
    right -= gap;
  };
  at_right("status unit", facts.unit);
  at_right("status selection", facts.selection);
  auto at_left = [&, x = left](const char* name, const std::string& text, float share, bool faint) mutable {
    const float room = std::min((right - x), share * (right - left));
    if (text.empty() || room < 4 * ImGui::GetFontSize()) return;
    ImGui::SetCursorPos(ImVec2(x, line));
    if (faint) ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
    elided_text(text, room);
    if (faint) ImGui::PopStyleColor();
    note_item(layout, name, text);
    x += std::min(room, text_width(text)) + gap;
  };
  // What is pointed at is what one looks for: it has the larger share.
  const float pointed = text_width(facts.pointed), setting = text_width(facts.setting);
  const bool both = pointed + setting + gap <= right - left;
  at_left("status setting", facts.setting, both || facts.pointed.empty() ? 1.0F : 0.35F, true);
  at_left("status pointed", facts.pointed, 1, false);
  ImGui::End();
}

std::optional<Arrangement> borders(const Arrangement& now, PanelLayout& layout) {
  const Places& places = layout.places;
  if (places.dock.empty()) return std::nullopt;
  Arrangement wanted = now;
  const float em = ImGui::GetFontSize(), reach = kGrid;
  const auto border = [&](const char* name, const Place& place, ImGuiMouseCursor cursor) {
    // A window of its own: it takes the pointer from the panels that it lies between.
    ImGui::SetNextWindowPos(ImVec2(place.x, place.y));
    ImGui::SetNextWindowSize(ImVec2(place.width, place.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0, 0, 0, 0));
    ImGui::Begin(name, nullptr, kPanelFlags);
    ImGui::InvisibleButton("border", ImVec2(place.width, place.height));
    const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
    draw_grip(*ImGui::GetWindowDrawList(), place);
    if (active || hovered) {
      ImGui::SetMouseCursor(cursor);
      ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(place.x, place.y), ImVec2(place.right(), place.bottom()),
                                                active ? kInformationColour : 0x60ffffffU);
    }
    note_item(layout, name, active ? "dragged" : "");
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    return active;
  };
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  if (border("border dock", {places.dock.x - reach / 2, places.dock.y, reach, places.dock.height}, ImGuiMouseCursor_ResizeEW))
    wanted.dock_ems = (static_cast<float>(layout.picture.width) - pointer.x) / em;
  if (border("border halves", {places.dock.x + reach, places.lower.y - reach / 2, places.dock.width - reach, reach},
             ImGuiMouseCursor_ResizeNS))
    wanted.upper_share = (pointer.y - places.dock.y) / std::max(places.dock.height, 1.0F);
  wanted = within_limits(wanted);
  return wanted == now ? std::nullopt : std::optional(wanted);
}

}  // namespace prismesh::kiosk::panels
