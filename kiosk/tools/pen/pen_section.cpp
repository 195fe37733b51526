#include "kiosk/tools/pen/pen_section.h"

#include "ipc/pen/page.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::pen {
namespace {

using ipc::PenStage;

bool is_in(const ipc::PenInfo& pen, PenStage stage) { return pen.state == ipc::name(stage); }

panels::Signal signal_of(const ipc::PenInfo& pen) {
  if (is_in(pen, PenStage::armed)) return panels::Signal::ok;
  const bool waits = is_in(pen, PenStage::disarmed) || is_in(pen, PenStage::homing) || is_in(pen, PenStage::setting_up);
  return waits ? panels::Signal::information : panels::Signal::warn;
}

}  // namespace

std::string advice_for(const ipc::PenInfo& pen, bool holds) {
  if (holds) return "Release the button to keep the move; Esc takes it back.";
  if (!pen.trouble.empty()) return is_in(pen, PenStage::latched) ? pen.trouble + " (Ctrl+Shift+P)" : pen.trouble;
  if (is_in(pen, PenStage::armed))
    return "Its first button takes what it touches, its second one moves its space. Ctrl+Shift+P disarms it.";
  if (is_in(pen, PenStage::disarmed)) return "Ctrl+Shift+P arms it: then it pushes back.";
  if (is_in(pen, PenStage::homing)) return "Move it to its stops once.";
  return {};
}

void pen_section(const ipc::PenInfo& pen, bool holds) {
  panels::section("Pen");
  panels::draw_signal(signal_of(pen), ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  panels::fact(pen.simulated ? "simulated" : "haptic pen", holds ? pen.state + ", holds" : pen.state);
  const std::string advice = advice_for(pen, holds);
  if (advice.empty()) return;
  ImGui::PushFont(panels::small_font());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(panels::printable(advice).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
}

float pen_section_height(const ipc::PenInfo& pen, bool holds, float width) {
  float height = 2.6f * ImGui::GetTextLineHeightWithSpacing();
  ImGui::PushFont(panels::small_font());
  if (const std::string advice = advice_for(pen, holds); !advice.empty())
    height += ImGui::CalcTextSize(advice.c_str(), nullptr, false, width).y + panels::kGrid / 2;
  ImGui::PopFont();
  return height;
}

}  // namespace prismesh::kiosk::tools::pen
