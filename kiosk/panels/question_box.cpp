#include "kiosk/panels/question_box.h"

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

constexpr std::size_t kMaxPaths = 6;  ///< of a list; the others are counted

void path_list(const Question::List& list) {
  ImGui::TextUnformatted(list.heading.c_str());
  const std::size_t shown = list.paths.size() > kMaxPaths ? kMaxPaths - 1 : list.paths.size();
  ImGui::Indent(2 * kGrid);
  for (std::size_t i = 0; i < shown; ++i) elided_text(printable(list.paths[i]), ImGui::GetContentRegionAvail().x);
  if (shown < list.paths.size()) ImGui::TextDisabled("%s", fmt::format("and {} more", list.paths.size() - shown).c_str());
  ImGui::Unindent(2 * kGrid);
  ImGui::Dummy(ImVec2(0, kGrid / 2));
}

}  // namespace

std::optional<Reply> question_box(const Question& question, const Place& room) {
  std::optional<Reply> reply;
  begin_centred("Question", room, ImGui::GetFontSize() * 40);
  ImGui::PushFont(title_font());
  ImGui::TextWrapped("%s", printable(question.title).c_str());
  ImGui::PopFont();
  ImGui::Dummy(ImVec2(0, kGrid / 2));
  if (!question.text.empty()) {
    ImGui::TextWrapped("%s", printable(question.text).c_str());
    ImGui::Dummy(ImVec2(0, kGrid / 2));
  }
  for (const Question::List& list : question.lists) path_list(list);
  float free = 0;  // width left in the line of buttons
  for (const Question::Choice& choice : question.choices) {
    const std::string label = printable(fmt::format("{}  ({})", choice.label, choice.key_name));
    const float width = ImGui::CalcTextSize(label.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (free >= kGrid + width)
      ImGui::SameLine(0, kGrid);
    else
      free = ImGui::GetContentRegionAvail().x + kGrid;
    free -= kGrid + width;
    if (ImGui::Button(label.c_str())) reply = choice.reply;
  }
  ImGui::End();
  return reply;
}

}  // namespace prismesh::kiosk::panels
