#include "kiosk/panels/panels.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using tools::Command;

/// `bottom`: the legends stand below it.
void notice_panel(const PanelData& data, display::PixelSize picture, float bottom, Actions& actions) {
  if (!data.notice) return;
  const float side = data.document ? side_width(picture) + 2 * kMargin : kMargin;
  const float width = static_cast<float>(picture.width) - 2 * side;
  ImGui::SetNextWindowPos(ImVec2(side, bottom), 0, ImVec2(0, 1));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin("Notice", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const Notice::Kind kind = data.notice->kind;
  draw_signal(kind == Notice::Kind::error     ? Signal::fail
              : kind == Notice::Kind::warning ? Signal::warn
                                              : Signal::information,
              ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  const std::string read = data.more_notices > 0 ? fmt::format("next ({})", data.more_notices) : "close";
  const char* const list = "list all";
  const auto width_of = [](const char* label) { return ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x; };
  const float buttons = data.notice->lists_warnings ? std::max(width_of(read.c_str()), width_of(list)) : width_of(read.c_str());
  const float buttons_at = ImGui::GetWindowContentRegionMax().x - buttons, end = buttons_at - 2 * kGrid;
  ImGui::PushTextWrapPos(end);  // for a path that is wider than the panel; left alone the toolkit would break numbers at their point
  ImGui::TextUnformatted(break_at_spaces(printable_lines(data.notice->text), end - ImGui::GetCursorPosX(), [](std::string_view piece) {
                           return ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x;
                         }).c_str());
  ImGui::PopTextWrapPos();
  ImGui::SameLine();
  ImGui::SetCursorPosX(buttons_at);
  ImGui::BeginGroup();
  if (ImGui::SmallButton(read.c_str())) actions.emplace_back(NoticeRead{});
  if (data.notice->lists_warnings) {
    if (ImGui::SmallButton(list)) actions.emplace_back(Command::deck_warnings);
    hint(Command::deck_warnings);
  }
  ImGui::EndGroup();
  ImGui::End();
}

/// What stands in the middle while there is no model to see or the model server is busy.
void state_panel(const PanelData& data, display::PixelSize picture) {
  if (data.connected && data.document && data.busy.empty()) return;
  if (data.connected && (data.dialog != Dialog::none || data.question != nullptr)) return;
  begin_centred("State", picture, ImGui::GetFontSize() * 32);
  if (!data.connected) {
    ImGui::PushFont(title_font());
    ImGui::TextWrapped("The model server is not running - trying again");
    ImGui::PopFont();
    ImGui::TextDisabled("Nothing is lost: acknowledged edits are in its journal.");
    ImGui::PushFont(small_font());
    ImGui::TextDisabled("It is expected at");
    elided_text(printable(data.socket), ImGui::GetContentRegionAvail().x);
    ImGui::PopFont();
  } else if (!data.busy.empty()) {
    ImGui::TextUnformatted(printable(data.busy).c_str());
    ImGui::ProgressBar(static_cast<float>(data.busy_fraction), ImVec2(-1, kGrid), "");
  } else {
    ImGui::PushFont(title_font());
    ImGui::TextUnformatted("No deck is open");
    ImGui::PopFont();
    ImGui::TextDisabled("Ctrl+O opens one, F1 shows all keys.");
  }
  ImGui::End();
}

/// What to do next, at the top where it is in nobody's way.
void guidance_panel(const PanelData& data, display::PixelSize picture) {
  if (data.guidance.empty() || !data.document) return;
  ImGui::SetNextWindowPos(ImVec2(std::floor(static_cast<float>(picture.width) / 2), kMargin), 0, ImVec2(0.5f, 0));
  ImGui::Begin("Guidance", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  draw_signal(Signal::information, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  ImGui::TextUnformatted(printable(data.guidance).c_str());
  ImGui::End();
}

bool is_path(Dialog dialog) { return dialog == Dialog::open || dialog == Dialog::save_as || dialog == Dialog::save_copy; }

/// Tab: the text becomes what all offered entries begin with.
int complete(ImGuiInputTextCallbackData* data) {
  if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways) {
    // A field that takes the keyboard by itself selects all of its text; a path is meant to be gone on with.
    bool& just_opened = *static_cast<bool*>(data->UserData);
    if (std::exchange(just_opened, false)) {
      data->CursorPos = data->BufTextLen;
      data->ClearSelection();
    }
    return 0;
  }
  const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
  const std::string longer = common_beginning(completions(typed, 10000));
  if (longer.size() > typed.size()) data->InsertChars(data->BufTextLen, longer.c_str() + typed.size());
  return 0;
}

}  // namespace

Actions Panels::build(const PanelData& data, display::PixelSize picture) {
  Actions actions;
  float bottom = static_cast<float>(picture.height) - kMargin;
  covered_width_ = 2.0 * static_cast<double>(side_width(picture) + kMargin);
  const bool covered = data.help || data.warnings != nullptr || data.menu || data.question != nullptr || is_path(data.dialog);
  if (data.document && data.connected && !covered) {
    if (data.compare && data.compare->panel_open)
      compare_panel(data, picture, compare_entry_, actions);
    else if (data.quality)
      quality_panel(data, picture, actions);
    else if (data.shaping_open)
      shaping_panel(data, picture, actions);
    else
      document_panel(data, picture, actions);
    model_panel(data, picture, actions);
    if (data.compare)
      for (const LegendFacts& facts : data.compare->legends) {
        const DrawnLegend drawn = legend(facts, picture);
        if (drawn.wanted) actions.emplace_back(*drawn.wanted);
        bottom = std::min(bottom, drawn.top - kGrid);
      }
    if (data.compare) view_captions(*data.compare, picture, data.guidance.empty() ? kMargin : kMargin + 3 * ImGui::GetFontSize());
  }
  state_panel(data, picture);
  if (data.connected && data.question != nullptr) {
    question_box(*data.question, picture, actions);
    shown_dialog_ = Dialog::none;
  } else if (data.connected && data.dialog != Dialog::none)
    build_dialog(data, picture, actions);
  else
    shown_dialog_ = Dialog::none;
  if (data.help) help_panel(data, picture);
  if (data.menu) menu_panel(data, picture, actions);
  if (data.warnings != nullptr) warnings_panel(data, picture);
  guidance_panel(data, picture);
  notice_panel(data, picture, bottom, actions);
  return actions;
}

void Panels::build_dialog(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const bool opened = std::exchange(shown_dialog_, data.dialog) != data.dialog;
  if (data.dialog == Dialog::expression) return expression_box(data, picture, opened, entry_, actions);
  if (data.dialog == Dialog::number) return number_box(data, picture, opened, entry_, actions);
  begin_centred("Path", picture, ImGui::GetFontSize() * 44);
  build_path(data, actions, opened);
  ImGui::End();
}

void Panels::build_path(const PanelData& data, Actions& actions, bool opened) {
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(data.dialog == Dialog::open        ? "Open a deck"
                         : data.dialog == Dialog::save_copy ? "Save a copy"
                                                            : "Save as another deck");
  ImGui::PopFont();
  if (opened) {
    const std::filesystem::path current(data.document ? data.document->path : "");
    typed_ = data.dialog != Dialog::open || !data.document ? current.string() : (current.parent_path() / "").string();
    caret_to_end_ = true;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputText(
      "##path", &typed_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways,
      complete, &caret_to_end_);
  ImGui::PushFont(small_font());
  if (offered_for_ != typed_) {
    offered_ = completions(typed_, 8);
    offered_for_ = typed_;
  }
  for (const std::string& entry : offered_)
    if (ImGui::Selectable(printable(entry).c_str())) typed_ = entry;
  ImGui::TextDisabled("Tab completes, Enter %s, Esc closes", data.dialog == Dialog::open ? "opens" : "saves");
  if (data.document && data.dialog != Dialog::open) {
    const std::string name = std::filesystem::path(data.document->path).filename().string();
    elided_text(
        printable(data.dialog == Dialog::save_copy ? "You go on with " + name + "."
                                                   : "You go on with the new deck. " + name + " stays on disk as it was last saved."),
        ImGui::GetContentRegionAvail().x);
  }
  ImGui::PopFont();
  if (entered && !typed_.empty()) {
    if (data.dialog == Dialog::open)
      actions.emplace_back(AskOpen{typed_});
    else
      actions.emplace_back(AskSave{typed_, data.dialog == Dialog::save_copy});
    actions.emplace_back(DialogClosed{});
  }
}

}  // namespace prismesh::kiosk::panels
