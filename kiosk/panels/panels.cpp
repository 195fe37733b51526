#include "kiosk/panels/panels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using mesh::document::VisibilityAction;
using mesh::quality::Counts;
using tools::Command;
using Actions = std::vector<PanelAction>;

std::string guessed(const std::string& value, bool is_guess) { return is_guess ? value + " (guessed)" : value; }

void document_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const DocumentFacts& document = *data.document;
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowSize(ImVec2(side_width(picture), 0));
  ImGui::Begin("Document", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const float width = ImGui::GetContentRegionAvail().x;
  const std::filesystem::path path(document.path);
  ImGui::PushFont(title_font());
  elided_text(printable(path.filename().string()), width);
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(printable(path.parent_path().string()), width);
  ImGui::PopStyleColor();
  ImGui::TextUnformatted(document.changed ? "unsaved edits" : "no unsaved edits");
  ImGui::PopFont();

  section("Model");
  fact("shells", grouped(document.shells));
  fact("nodes", grouped(document.nodes));
  fact("parts", grouped(document.parts.size()));
  fact("length unit", guessed(document.length_unit, document.length_unit_guessed));
  fact("target size", guessed(length_text(document.target_size, document.length_unit), document.target_size_guessed));
  fact("generation", grouped(document.generation));

  section("Selection");
  fact("nodes", grouped(document.selected_nodes));
  if (document.selected_shells > 0) fact("shells", grouped(document.selected_shells));
  ImGui::TextDisabled("rectangle takes");
  if (ImGui::RadioButton("visible nodes", !data.through) && data.through) actions.emplace_back(Command::toggle_through);
  if (ImGui::RadioButton("all nodes through the model", data.through) && !data.through) actions.emplace_back(Command::toggle_through);

  section("Picture");
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("colour by");
  ImGui::SameLine();
  if (ImGui::RadioButton("part", !data.colour_by_quality) && data.colour_by_quality) actions.emplace_back(Command::colour_mode);
  ImGui::SameLine();
  if (ImGui::RadioButton("quality", data.colour_by_quality) && !data.colour_by_quality) actions.emplace_back(Command::colour_mode);
  ImGui::TextDisabled("display");
  ImGui::SameLine();
  if (ImGui::SmallButton(data.profile.c_str())) actions.emplace_back(Command::next_profile);

  if (data.pull) {
    section(data.pull->what.c_str());
    fact("distance", length_text(data.pull->length, document.length_unit));
    fact("nodes that move", grouped(data.pull->nodes));
  }
  ImGui::Dummy(ImVec2(0, kGrid / 2));
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("F1  keys and mouse");
  ImGui::PopFont();
  ImGui::End();
}

void quality_row(const char* label, Signal signal, std::size_t before, const std::optional<std::size_t>& now) {
  draw_signal(signal, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  std::string value = grouped(before);
  if (now && *now != before) value += " \u2192 " + grouped(*now);
  fact(label, value);
}

void quality_section(const PanelData& data) {
  const Counts& before = data.document->counts;
  std::optional<std::size_t> ok, warn, failed;
  if (data.pull && data.pull->counts) {
    ok = data.pull->counts->ok;
    warn = data.pull->counts->warn;
    failed = data.pull->counts->fail;
  }
  ImGui::TextUnformatted("Shell quality");
  quality_row("ok", Signal::ok, before.ok, ok);
  quality_row("warn", Signal::warn, before.warn, warn);
  quality_row("fail", Signal::fail, before.fail, failed);
  if (data.glyphs_left_out > 0) {
    ImGui::PushFont(small_font());
    ImGui::TextDisabled("%s more marks than can be drawn", grouped(data.glyphs_left_out).c_str());
    ImGui::PopFont();
  }
}

/// A padlock, closed or (faint) open; true when clicked.
bool lock_button(bool locked) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton("lock", ImVec2(size, size));
  const unsigned colour = locked ? kInk : (ImGui::IsItemHovered() ? kFaintInk : 0x60aaa6a2u);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = at.x + size * 0.25f, y = at.y + size * 0.5f, w = size * 0.5f;
  list.AddRectFilled(ImVec2(x, y), ImVec2(x + w, y + size * 0.38f), colour, 1);
  const float radius = w * 0.34f, cx = x + w / 2 + (locked ? 0 : w * 0.5f);
  list.PathArcTo(ImVec2(cx, y), radius, 3.14159f, 6.28318f, 12);
  list.PathStroke(colour, 0, size * 0.1f);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(locked ? "locked: its nodes don't move" : "lock: its nodes shall not move");
  return clicked;
}

void part_row(const PartRow& part, Actions& actions) {
  ImGui::PushID(static_cast<int>(part.id & 0x7fffffff));
  const float line = ImGui::GetTextLineHeight(), right = ImGui::GetWindowContentRegionMax().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("show", ImVec2(line, line)))
    actions.emplace_back(AskPart{part.id, part.hidden ? VisibilityAction::show : VisibilityAction::hide});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(part.hidden ? "hidden: show" : "shown: hide");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low(at.x + line * 0.15f, at.y + line * 0.15f), high(at.x + line * 0.85f, at.y + line * 0.85f);
  if (part.hidden)
    list.AddRect(low, high, part.colour, 2, 0, 1.5f);
  else
    list.AddRectFilled(low, high, part.colour, 2);
  ImGui::SameLine();

  const float only_width = ImGui::CalcTextSize("only").x, only_x = right - line - kGrid - only_width;
  const std::string label = part.name.empty() ? fmt::format("part {}", part.id) : fmt::format("{}  {}", part.id, printable(part.name));
  const std::string shells = grouped(part.shells);
  const float shells_width = ImGui::CalcTextSize(shells.c_str()).x;
  const float name_width = only_x - kGrid - shells_width - kGrid - ImGui::GetCursorPosX();
  if (part.hidden) ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(label, name_width);
  if (part.hidden) ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x - kGrid - shells_width);
  ImGui::TextDisabled("%s", shells.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x);
  const ImVec2 only_at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("only", ImVec2(only_width, line))) actions.emplace_back(AskPart{part.id, VisibilityAction::only});
  list.AddText(only_at, ImGui::IsItemHovered() ? kInk : 0x80aaa6a2u, "only");
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - line);
  if (lock_button(part.locked)) actions.emplace_back(AskPart{part.id, part.locked ? VisibilityAction::unlock : VisibilityAction::lock});
  ImGui::PopID();
}

/// How tracked eyes and the mask are: a line when all is well, and what to do about it when it isn't.
void eyes_section(const EyesFacts& eyes) {
  section("Eyes");
  const bool good = eyes.state == EyesFacts::State::good, waiting = eyes.state == EyesFacts::State::waiting;
  draw_signal(good ? Signal::ok : waiting ? Signal::information : Signal::warn, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  fact(eyes.eyes.c_str(), eyes.in_depth ? "in depth" : "flat");
  if (!eyes.mask.empty()) fact("prism mask", eyes.mask);
  if (eyes.simulated) fact("devices", "simulated");
  if (eyes.advice.empty()) return;
  ImGui::PushFont(small_font());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(printable(eyes.advice).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
}

void depth_row(const char* label, const std::string& value, Command less, Command more, Actions& actions) {
  const float button = ImGui::GetFrameHeight(), right = ImGui::GetWindowContentRegionMax().x;
  ImGui::PushID(label);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - 2 * kGrid - ImGui::CalcTextSize(value.c_str()).x);
  ImGui::TextUnformatted(value.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - kGrid / 2);
  if (ImGui::Button("-", ImVec2(button, 0))) actions.emplace_back(less);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - button);
  if (ImGui::Button("+", ImVec2(button, 0))) actions.emplace_back(more);
  ImGui::PopID();
}

void depth_section(const DepthFacts& depth, Actions& actions) {
  section("Depth");
  depth_row("strength", fmt::format("{} %", depth.strength_percent), Command::less_depth, Command::more_depth, actions);
  depth_row("parallax up to", fmt::format("{:.1f}\u00b0", depth.comfort_degrees), Command::narrower_comfort, Command::wider_comfort,
            actions);
  bool kept = depth.selection_in_plane;
  if (ImGui::Checkbox("selection at the screen", &kept)) actions.emplace_back(Command::keep_selection_in_plane);
}

/// How high the two sections above will be, so that the panel fits its content.
float stereo_height(const PanelData& data, float width) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  float height = 0;
  if (data.eyes) {
    height += line * (2.6f + (data.eyes->mask.empty() ? 0 : 1) + (data.eyes->simulated ? 1 : 0));
    ImGui::PushFont(small_font());
    if (!data.eyes->advice.empty()) height += ImGui::CalcTextSize(data.eyes->advice.c_str(), nullptr, false, width).y + kGrid / 2;
    ImGui::PopFont();
  }
  if (data.depth) height += line * 1.6f + 3 * ImGui::GetFrameHeightWithSpacing();
  return height;
}

void model_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const float width = side_width(picture), most = static_cast<float>(picture.height) - 2 * kMargin;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(picture.width) - kMargin - width, kMargin));
  const auto rows = static_cast<float>(data.document->parts.size());
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::SetNextWindowSize(
      ImVec2(width, std::min(most, on_grid(line * (rows + 7.0f) + 4 * kGrid + stereo_height(data, width - 4 * kGrid)))));
  ImGui::Begin("Quality and parts", nullptr, kPanelFlags);
  quality_section(data);
  if (data.eyes) eyes_section(*data.eyes);
  if (data.depth) depth_section(*data.depth, actions);
  section("Parts");
  const auto hidden =
      std::count_if(data.document->parts.begin(), data.document->parts.end(), [](const PartRow& part) { return part.hidden; });
  if (hidden > 0) {
    const std::string label = fmt::format("show all ({} hidden)", hidden);
    ImGui::SameLine();
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(label.c_str()).x - 2 * kGrid);
    if (ImGui::SmallButton(label.c_str())) actions.emplace_back(Command::show_all);
  }
  ImGui::BeginChild("list");
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(data.document->parts.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) part_row(data.document->parts[static_cast<std::size_t>(i)], actions);
  ImGui::EndChild();
  ImGui::End();
}

void notice_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  if (!data.notice) return;
  const float side = data.document ? side_width(picture) + 2 * kMargin : kMargin;
  const float width = static_cast<float>(picture.width) - 2 * side;
  ImGui::SetNextWindowPos(ImVec2(side, static_cast<float>(picture.height) - kMargin), 0, ImVec2(0, 1));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin("Notice", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const Notice::Kind kind = data.notice->kind;
  draw_signal(kind == Notice::Kind::error     ? Signal::fail
              : kind == Notice::Kind::warning ? Signal::warn
                                              : Signal::information,
              ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  const std::string read = data.more_notices > 0 ? fmt::format("next ({})", data.more_notices) : "close";
  const float button = ImGui::CalcTextSize(read.c_str()).x + 4 * kGrid;
  ImGui::PushTextWrapPos(ImGui::GetWindowContentRegionMax().x - button);
  ImGui::TextUnformatted(printable(data.notice->text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - button + 2 * kGrid);
  if (ImGui::SmallButton(read.c_str())) actions.emplace_back(NoticeRead{});
  ImGui::End();
}

void begin_centred(const char* name, display::PixelSize picture, float width) {
  ImGui::SetNextWindowPos(ImVec2(std::floor(static_cast<float>(picture.width) / 2), std::floor(static_cast<float>(picture.height) / 2)), 0,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(ImVec2(on_grid(std::min(width, static_cast<float>(picture.width) - 2 * kMargin)), 0));
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
}

/// What stands in the middle while there is no model to see or the model server is busy.
void state_panel(const PanelData& data, display::PixelSize picture) {
  if (data.connected && data.document && data.busy.empty()) return;
  if (data.connected && data.dialog != Dialog::none) return;
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

/// Two columns, `width` pixels wide from `x`: what to press, and what it does.
template <class Bindings, class Left>
void binding_list(const char* title, const Bindings& bindings, const Left& left, float x, float width) {
  ImGui::SetCursorPosX(x);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(title);
  ImGui::PopFont();
  float label_width = 0;
  for (const auto& binding : bindings)
    label_width = std::max(label_width, ImGui::CalcTextSize(left(binding).data(), left(binding).data() + left(binding).size()).x);
  for (const auto& binding : bindings) {
    ImGui::SetCursorPosX(x);
    ImGui::TextUnformatted(left(binding).data(), left(binding).data() + left(binding).size());
    ImGui::SameLine(x + label_width + 2 * kGrid);
    ImGui::PushTextWrapPos(x + width);
    ImGui::TextDisabled("%s", std::string(binding.meaning).c_str());
    ImGui::PopTextWrapPos();
  }
}

void help_panel(display::PixelSize picture) {
  const float widest = static_cast<float>(picture.width) - 2 * kMargin, highest = static_cast<float>(picture.height) - 2 * kMargin;
  const float width = on_grid(std::min(ImGui::GetFontSize() * 76, widest)), half = (width - 6 * kGrid) / 2;
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, highest));
  begin_centred("Keys and mouse", picture, width);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(kGrid, kGrid / 2));
  const float top = ImGui::GetCursorPosY();
  binding_list(
      "Keys", tools::key_bindings(), [](const tools::KeyBinding& binding) { return binding.label; }, 2 * kGrid, half);
  const float bottom = ImGui::GetCursorPosY();
  ImGui::SetCursorPosY(top);
  binding_list(
      "Mouse", tools::mouse_bindings(), [](const tools::MouseBinding& binding) { return binding.gesture; }, half + 4 * kGrid, half);
  ImGui::SetCursorPosY(std::max(bottom, ImGui::GetCursorPosY()));
  ImGui::PopStyleVar();
  ImGui::End();
}

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
  covered_width_ = 2.0 * static_cast<double>(side_width(picture) + kMargin);
  const bool covered = data.help || data.dialog != Dialog::none;
  if (data.document && data.connected && !covered) {
    document_panel(data, picture, actions);
    model_panel(data, picture, actions);
  }
  state_panel(data, picture);
  if (data.connected && data.dialog != Dialog::none)
    build_dialog(data, picture, actions);
  else
    shown_dialog_ = Dialog::none;
  if (data.help) help_panel(picture);
  notice_panel(data, picture, actions);
  return actions;
}

void Panels::build_dialog(const PanelData& data, display::PixelSize picture, Actions& actions) {
  begin_centred("Path", picture, ImGui::GetFontSize() * 44);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(data.dialog == Dialog::open ? "Open a deck" : "Save under another name");
  ImGui::PopFont();
  if (shown_dialog_ != data.dialog) {
    shown_dialog_ = data.dialog;
    const std::filesystem::path current(data.document ? data.document->path : "");
    typed_ = data.dialog == Dialog::save_as || !data.document ? current.string() : (current.parent_path() / "").string();
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
  ImGui::PopFont();
  if (entered && !typed_.empty()) {
    if (data.dialog == Dialog::open)
      actions.emplace_back(AskOpen{typed_});
    else
      actions.emplace_back(AskSaveAs{typed_});
    actions.emplace_back(DialogClosed{});
  }
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
