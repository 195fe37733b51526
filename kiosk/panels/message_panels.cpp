#include "kiosk/panels/message_panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {

using notices::Notice;

namespace {

/// From the cursor to `end`. A long report scrolls, so that it leaves the model in sight.
void notice_text(const std::string& text, float end) {
  constexpr float kMaxLines = 4;
  const float width = end - ImGui::GetCursorPosX();
  // What a list can draw is limited; nobody reads more here.
  constexpr std::size_t kMaxBytes = 6000;
  const std::string told = printable_lines(text.size() > kMaxBytes ? text.substr(0, kMaxBytes) + " .." : text);
  const auto lines_within = [&](float room) {
    return break_at_spaces(told, room,
                           [](std::string_view piece) { return ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x; });
  };
  const std::string all = lines_within(width);
  const float line = ImGui::GetTextLineHeight();
  const bool scrolls = ImGui::CalcTextSize(all.c_str(), nullptr, false, width).y > (kMaxLines + 0.5F) * line;
  if (scrolls) ImGui::BeginChild("report", ImVec2(width, (kMaxLines + 0.5F) * line));
  // For a path that is wider than the panel; left alone the toolkit would break numbers at their point.
  ImGui::PushTextWrapPos(scrolls ? 0 : end);
  ImGui::TextUnformatted((scrolls ? lines_within(ImGui::GetContentRegionAvail().x) : all).c_str());
  ImGui::PopTextWrapPos();
  if (scrolls) ImGui::EndChild();
}

}  // namespace

NoticeReply notice_panel(const NoticeFacts& facts, const Place& room, const NoticePlace& place) {
  NoticeReply reply = NoticeReply::none;
  ImGui::SetNextWindowPos(ImVec2(room.x + kMargin, static_cast<float>(place.bottom)), 0, ImVec2(0, 1));
  ImGui::SetNextWindowSize(ImVec2(room.width - 2 * kMargin, 0));
  ImGui::Begin("Notice", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const Notice::Kind kind = facts.notice.kind;
  draw_signal(kind == Notice::Kind::error     ? Signal::fail
              : kind == Notice::Kind::warning ? Signal::warn
                                              : Signal::information,
              ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  const std::string read = facts.more > 0 ? fmt::format("next ({})", facts.more) : "close";
  const char* const list = "list all";
  const auto width_of = [](const char* label) { return ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x; };
  const float buttons = facts.notice.lists_warnings ? std::max(width_of(read.c_str()), width_of(list)) : width_of(read.c_str());
  const float buttons_at = ImGui::GetWindowContentRegionMax().x - buttons, end = buttons_at - 2 * kGrid;
  // A dialog or a list that was opened meanwhile would cover it; a menu is about to be chosen from.
  if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
  notice_text(facts.notice.text, end);
  ImGui::SameLine();
  ImGui::SetCursorPosX(buttons_at);
  ImGui::BeginGroup();
  if (ImGui::SmallButton(read.c_str())) reply = NoticeReply::read;
  if (facts.notice.lists_warnings) {
    if (ImGui::SmallButton(list)) reply = NoticeReply::list_warnings;
    hint(place.list_warnings);
  }
  ImGui::EndGroup();
  ImGui::End();
  return reply;
}

void state_panel(const StateFacts& facts, const input::KeyBinding& open, PanelLayout& layout) {
  begin_centred("State", layout.view(), ImGui::GetFontSize() * 32);
  if (!facts.connected) {
    ImGui::PushFont(title_font());
    ImGui::TextWrapped("The model server is not running - trying again");
    ImGui::PopFont();
    ImGui::TextDisabled("Nothing is lost: acknowledged edits are in its journal.");
    ImGui::PushFont(small_font());
    ImGui::TextDisabled("It is expected at");
    elided_text(printable(facts.socket), ImGui::GetContentRegionAvail().x);
    ImGui::PopFont();
  } else if (!facts.busy.empty()) {
    ImGui::TextUnformatted(printable_lines(facts.busy).c_str());
    ImGui::ProgressBar(static_cast<float>(facts.busy_fraction), ImVec2(-1, kGrid), "");
  } else {
    ImGui::PushFont(title_font());
    ImGui::TextUnformatted("No deck is open");
    ImGui::PopFont();
    if (ImGui::Button("Open a deck ...")) layout.ask(open.command);
    note_item(layout, "open a deck", "");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s   F1 shows all keys", std::string(open.label).c_str());
  }
  ImGui::End();
}

void guidance_panel(const std::string& guidance, const Place& room) {
  ImGui::SetNextWindowPos(ImVec2(std::floor(room.x + room.width / 2), room.y + kMargin), 0, ImVec2(0.5f, 0));
  ImGui::Begin("Guidance", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  draw_signal(Signal::information, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  ImGui::TextUnformatted(printable(guidance).c_str());
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
