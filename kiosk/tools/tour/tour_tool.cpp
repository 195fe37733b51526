#include "kiosk/tools/tour/tour_tool.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::tools::tour {
namespace {

using input::KeyBinding;
using input::Menu;
using panels::PanelLayout;

constexpr std::string_view kName = "tour";
constexpr float kCardWidthInFonts = 22;

enum class TourCommand : std::uint8_t { tour };

constexpr std::array kKeys = {
    KeyBinding{display::Key::f1,
               false,
               true,
               {kName, static_cast<std::uint8_t>(TourCommand::tour)},
               Menu::help,
               "Shift+F1",
               "begin or end the tour of a first edit"},
};

enum StepOfTour : std::size_t { kOpen, kTurn, kSelect, kPull, kRepair, kCompare, kSave, kEnd, kSteps };

constexpr std::array<TourStep, kSteps> kTour{{
    {"Open a deck", "Ctrl+O lists the recent decks and the folders. Choose one with the arrow keys, and press Enter.", "Ctrl+O",
     "open a deck"},
    {"Look around", "Drag with the right button to turn the view, with the middle one to move it. The wheel zooms. Ctrl+F fits the model.",
     "Ctrl+F"},
    {"Select a face",
     "Double click a shell: the face about it is selected, up to the creases. A drag with the left button selects what it goes round.", ""},
    {"Pull",
     "Drag the arrow that stands on the selection. Shells that would fail are red meanwhile, those that would warn yellow. Digits set the "
     "length exactly. T shows how the pull fades out.",
     "T", kAtHandle},
    {"Repair",
     "Ctrl+E repairs what the pull made worse, and nothing elsewhere. If nothing got worse, pull farther: the dock counts what warns and "
     "fails.",
     "Ctrl+E", "rail Quality"},
    {"Compare",
     "C shows the state before the last edit; C again goes back. Ctrl+C shows the deck as it was opened beside the present state.", "C",
     "rail Compare"},
    {"Save a copy",
     "Ctrl+Shift+C saves a copy under another name: only the lines of what changed are written anew. Ctrl+S would save in place.",
     "Ctrl+Shift+C", "deck"},
    {"That is all",
     "Every edit goes this way. Ctrl+Z takes an edit back, the tab History lists them all. Ctrl+P finds any command by its words; F1 lists "
     "the keys.",
     "Ctrl+P", "find"},
}};

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::span<const TourStep> tour_steps() { return kTour; }

std::string_view TourTool::name() const { return kName; }

void TourTool::command(std::uint8_t, const toolkit::Pointer&) {
  if (step_) return end();
  go_to(context_.shown.snapshot ? kTurn : kOpen);
}

void TourTool::end() {
  step_.reset();
  ++context_.changes;
  context_.trace.line("tour none");
}

void TourTool::go_to(std::size_t step) {
  if (step == kSave && context_.options.exhibition) step += step_ > step ? -1 : 1;  // there nothing is saved
  if (step >= kSteps) return end();
  step_ = step;
  began_ = context_.shown.snapshot ? context_.shown.snapshot->info().generation : 0;
  seen_ = context_.view.view;
  unsaved_ = context_.shown.snapshot && context_.shown.snapshot->info().changed;
  ++context_.changes;
  context_.follow_soon = true;
  context_.trace.line(fmt::format("tour {} of {} {}", step + 1, static_cast<std::size_t>(kSteps), kTour[step].title));
}

void TourTool::look(std::int64_t) {
  const stereo::View& view = context_.view.view;
  if (step_ == kTurn && (!view.rotation.isApprox(seen_.rotation) || view.mm_per_unit != seen_.mm_per_unit)) go_to(*step_ + 1);
}

bool TourTool::done() const {
  const auto& shown = context_.shown.snapshot;
  if (!shown) return false;
  const bool newer = shown->info().generation != began_;
  const std::string& made_by = context_.link.document.made_by();
  const auto made_by_one_of = [&](std::initializer_list<std::string_view> names) {
    return newer && std::find(names.begin(), names.end(), made_by) != names.end();
  };
  switch (*step_) {
    case kOpen: return true;
    case kSelect: return context_.selection.centre.has_value();
    case kPull: return made_by_one_of({"lift", "translate", "slide", "move", "rotate"});
    case kRepair: return made_by_one_of({"repair", "relax"});
    case kCompare: return context_.shown.older || !context_.tools.colours().empty();
    case kSave: return unsaved_ && !shown->info().changed;
    default: return false;  // look() ends kTurn, a click the last one
  }
}

Result<void> TourTool::follow() {
  if (step_ && done()) go_to(*step_ + 1);
  return {};
}

/// Draws a frame around what the step is about, where that is on the screen.
void TourTool::mark_place(PanelLayout& layout) const {
  const std::string_view place = kTour[*step_].place;
  constexpr float kRound = 6, kLine = 3, kHandleRadius = 46;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  if (place == kAtHandle) {
    const auto& centre = context_.selection.centre;
    const auto at = centre ? stereo::pixel_of(toolkit::aim(context_.view), *centre) : std::nullopt;
    if (!at || context_.tools.pulling()) return;
    list.AddCircle(ImVec2(static_cast<float>(at->x()), static_cast<float>(at->y())), kHandleRadius, panels::kInformationColour, 0, kLine);
    return layout.items.push_back({"tour place", std::string(place), {}});
  }
  const auto item = std::ranges::find(layout.items, place, &panels::ScreenItem::name);
  if (place.empty() || item == layout.items.end()) return;
  const panels::Place& around = item->place;
  list.AddRect(ImVec2(around.x - kLine, around.y - kLine), ImVec2(around.right() + kLine, around.bottom() + kLine),
               panels::kInformationColour, kRound, 0, kLine);
  layout.items.push_back({"tour place", std::string(place), around});
}

void TourTool::draw_over_picture(PanelLayout& layout) {
  if (!step_) return;
  mark_place(layout);
  const panels::Place view = layout.view();
  const float font = ImGui::GetFontSize();
  const auto room = static_cast<float>(view.width) - 2 * panels::kMargin;
  if (room < 8 * font) return;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(view.x) + panels::kMargin, static_cast<float>(layout.bottom)), 0, ImVec2(0, 1));
  ImGui::SetNextWindowSize(ImVec2(std::min(kCardWidthInFonts * font, room), 0));
  ImGui::Begin("Tour", nullptr, panels::kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const TourStep& step = kTour[*step_];
  ImGui::PushFont(panels::small_font());
  ImGui::TextDisabled("%s", fmt::format("tour, {} of {}", *step_ + 1, static_cast<std::size_t>(kSteps)).c_str());
  ImGui::PopFont();
  ImGui::TextUnformatted(step.title.data());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(step.words.data());
  ImGui::PopTextWrapPos();
  const auto button = [&](const char* label, const char* tooltip, auto action) {
    if (ImGui::Button(label)) layout.ask(action);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
    panels::note_item(layout, std::string("tour ") + label, "");
    ImGui::SameLine();
  };
  if (*step_ > 0) button("back", "the step before", [this] { go_to(*step_ - 1); });
  if (*step_ + 1 < kSteps) button("next", "go on without doing it", [this] { go_to(*step_ + 1); });
  button("end", "end the tour; Shift+F1 begins it again", [this] { end(); });
  ImGui::NewLine();
  layout.bottom = std::min(layout.bottom, static_cast<double>(ImGui::GetWindowPos().y) - static_cast<double>(panels::kGrid));
  ImGui::End();
}

}  // namespace prismesh::kiosk::tools::tour
