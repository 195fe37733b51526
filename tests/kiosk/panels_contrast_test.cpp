// Words on panels can be read: their contrast with what is behind them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "kiosk/tools/parts/part_list.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::parts {
namespace {

/// For text of ordinary size: WCAG 2.1, success criterion 1.4.3.
constexpr double kMinContrast = 4.5;

double channel(unsigned colour, int shift) { return (colour >> shift & 0xffU) / 255.0; }

/// One channel of `colour` (0xAABBGGRR) over the panel, as linear light (WCAG 2.1, "relative luminance").
double light_on_panel(unsigned colour, int shift) {
  const double alpha = channel(colour, 24);
  const double value = alpha * channel(colour, shift) + (1 - alpha) * channel(panels::kPanelColour, shift);
  return value <= 0.03928 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double luminance(unsigned colour) {
  return 0.2126 * light_on_panel(colour, 0) + 0.7152 * light_on_panel(colour, 8) + 0.0722 * light_on_panel(colour, 16);
}

double contrast_on_panel(unsigned colour) {
  const auto [dark, light] = std::minmax({luminance(colour), luminance(panels::kPanelColour)});
  return (light + 0.05) / (dark + 0.05);
}

TEST(Contrast, every_colour_with_a_meaning_can_be_read_on_a_panel) {
  EXPECT_EQ(panels::kPanelColour >> 24, 0xffU) << "the model doesn't show through";
  for (const unsigned colour :
       {panels::kInk, panels::kFaintInk, panels::kWarnColour, panels::kFailColour, panels::kInformationColour, panels::kActiveColour})
    EXPECT_GE(contrast_on_panel(colour), kMinContrast) << fmt::format("{:08x}", colour);
}

struct FaintestWord {
  double contrast = 21;  // of white on black
  std::size_t glyphs = 0;
};

/// The glyphs of the last layout. They are the quads with a width in the texture; filled shapes take all corners from one white texel.
FaintestWord faintest_word() {
  FaintestWord found;
  const ImDrawData& drawn = *ImGui::GetDrawData();
  for (int l = 0; l < drawn.CmdListsCount; ++l) {
    const ImDrawList& list = *drawn.CmdLists[l];
    for (int i = 0; i + 2 < list.IdxBuffer.Size; i += 3) {
      const ImDrawVert& first = list.VtxBuffer[list.IdxBuffer[i]];
      const ImDrawVert& second = list.VtxBuffer[list.IdxBuffer[i + 1]];
      if (first.uv.x == second.uv.x && first.uv.y == second.uv.y) continue;
      ++found.glyphs;
      found.contrast = std::min(found.contrast, contrast_on_panel(first.col));
    }
  }
  return found;
}

using ContrastOfPanels = panels::GuiTest;

TEST_F(ContrastOfPanels, every_word_of_the_parts_can_be_read) {
  PartFacts facts;
  facts.parts = {{1, "RAIL", 1200, {2, 0}, 0xff4080c0, false, false, true}, {2, "SILL", 800, {0, 3}, 0xff40c080, true, true, false}};
  facts.files = {{"car.k", 1200, {1}, {2, 0}, false, false}, {"trim.k", 800, {2}, {0, 3}, true, true}};
  PartTree tree;
  tree.set_facts(std::move(facts));
  panels::PanelLayout layout{{1000, 640}};
  for (int round = 0; round < 3; ++round) {
    gui_->layout(layout.picture, 0.016, [&] {
      ImGui::SetNextWindowPos(ImVec2(0, 0));
      ImGui::SetNextWindowSize(ImVec2(400, 600));
      ImGui::Begin("parts", nullptr, ImGuiWindowFlags_NoTitleBar);
      part_list(tree, layout);
      ImGui::End();
    });
  }
  const FaintestWord faintest = faintest_word();
  EXPECT_GT(faintest.glyphs, 40U) << "names, counts, columns and actions";
  EXPECT_GE(faintest.contrast, kMinContrast);
}

}  // namespace
}  // namespace prismesh::kiosk::tools::parts
