#include "kiosk/panels/hand_marks.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "kiosk/panels/layout.h"

namespace prismesh::kiosk::panels {
namespace {

constexpr float kHighlightPixels = 8;                                               ///< wide: about the part, which stays visible
constexpr unsigned kHighlightColour = (kActiveColour & 0x00ffffffU) | 0xa0000000U;  ///< 0xAABBGGRR
constexpr float kBesidePointer = 2 * kGrid;                                         ///< beside what the pointer's own arrow hides

}  // namespace

void highlight_part(std::span<const std::vector<Eigen::Vector2d>> lines, const PanelLayout& layout) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Place view = layout.view();
  list.PushClipRect(ImVec2(view.x, view.y), ImVec2(view.right(), view.bottom()));
  for (const std::vector<Eigen::Vector2d>& line : lines) {
    for (const Eigen::Vector2d& at : line) list.PathLineTo(ImVec2(static_cast<float>(at.x()), static_cast<float>(at.y())));
    list.PathStroke(kHighlightColour, 0, kHighlightPixels);
  }
  list.PopClipRect();
}

void words_at_hand(const std::string& words, const Eigen::Vector2d& pointer, PanelLayout& layout) {
  const Place view = layout.view();
  const ImVec2 text = ImGui::CalcTextSize(words.c_str());
  Place box{0, 0, std::ceil(text.x) + kGrid, std::ceil(text.y)};
  const auto within = [](double at, float low, float high) {
    return std::round(std::max(low, std::min(static_cast<float>(at) + kBesidePointer, high)));
  };
  box.x = within(pointer.x(), view.x, view.right() - box.width);
  box.y = within(pointer.y(), view.y, view.bottom() - box.height);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(ImVec2(box.x, box.y), ImVec2(box.right(), box.bottom()), kPanelColour);
  list.AddText(ImVec2(box.x + kGrid / 2, box.y), kInk, words.c_str());
  layout.items.push_back({"hand", words, box});
}

}  // namespace prismesh::kiosk::panels
