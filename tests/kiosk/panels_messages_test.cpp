#include "kiosk/panels/message_panels.h"

#include <algorithm>
#include <vector>

#include <imgui_internal.h>

#include <gtest/gtest.h>

#include "kiosk/panels/warnings_panel.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::panels {
namespace {

const input::KeyBinding kList{display::letter('I'), true, false, {"editor", 0}, input::Menu::file, "Ctrl+I", "list"};

class Messages : public GuiTest {
 protected:
  /// The height of a notice at the foot of a view of 800 x 600.
  float height_of(const std::string& text) {
    float height = 0;
    for (int round = 0; round < 4; ++round)
      gui_->layout({800, 600}, 0.016, [&] {
        notice_panel({{notices::Notice::Kind::information, text}, 0}, {0, 0, 800, 600}, {590, kList});
        height = ImGui::FindWindowByName("Notice")->Size.y;
      });
    return height;
  }
};

TEST_F(Messages, a_long_report_scrolls_instead_of_covering_the_model) {
  std::string report = "Repaired: 12 nodes";
  const float one = height_of(report);
  for (int line = 0; line < 3; ++line) report += "\nshell:1: it lies between edges of the part that have to stay";
  const float four = height_of(report);
  EXPECT_GT(four, one + 2 * kFlatType.body) << "a short one is read whole";
  for (int line = 0; line < 200; ++line) report += "\nshell:1: it lies between edges of the part that have to stay";
  EXPECT_LT(height_of(report), four + 1.5F * kFlatType.body);
  EXPECT_LT(height_of(std::string(100000, 'x')), four + 1.5F * kFlatType.body) << "without a space to break at";
}

TEST_F(Messages, thousands_of_warnings_are_listed_with_how_many_more_there_are) {
  const std::vector<notices::ToldWarning> warnings(20'000, {false, "a.k:1", "part 1 is defined, but nothing uses it"});
  for (int round = 0; round < 3; ++round) {
    gui_->feed(display::WheelTurned{-1000, 400, 300, {}});
    gui_->layout({800, 600}, 0.016, [&] { warnings_panel(warnings, "/d/a.k", {0, 0, 800, 600}); });
  }
  int vertices = 0;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->WasActive || window->Active) vertices = std::max(vertices, window->DrawList->VtxBuffer.Size);
  EXPECT_LT(vertices, 1 << 15) << "rows out of sight are drawn, and the list of what is drawn is limited";
}

TEST_F(Messages, a_notice_is_seen_over_a_dialog) {
  for (int round = 0; round < 4; ++round)
    gui_->layout({800, 600}, 0.016, [&] {
      notice_panel({{notices::Notice::Kind::error, "it can't be read"}, 0}, {0, 0, 800, 600}, {590, kList});
      begin_centred("Path", {0, 0, 800, 600}, 400);
      if (round == 1) ImGui::SetWindowFocus();
      ImGui::Dummy(ImVec2(10, 500));
      ImGui::End();
    });
  const auto& windows = ImGui::GetCurrentContext()->Windows;
  const auto place = [&](const char* name) { return windows.find(ImGui::FindWindowByName(name)) - windows.begin(); };
  EXPECT_GT(place("Notice"), place("Path"));
}

}  // namespace
}  // namespace prismesh::kiosk::panels
