// Panels laid out without a window, for tests that click on them.
#pragma once

#include <optional>
#include <utility>

#include "kiosk/panels/gui.h"
#include "kiosk/panels/layout.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::panels {

class GuiTest : public render::RenderTest {
 protected:
  void SetUp() override {
    RenderTest::SetUp();
    if (IsSkipped()) return;
    auto gui = Gui::create();
    ASSERT_TRUE(gui) << gui.error().text();
    gui_.emplace(std::move(*gui));
    ASSERT_TRUE(gui_->set_type(kFlatType));
  }
  void TearDown() override {
    gui_.reset();
    RenderTest::TearDown();
  }

  /// Lays a tool's panel out as the kiosk does: in the dock, where it scrolls. Inside Gui::layout.
  template <class Build>
  static void in_dock(display::PixelSize picture, const Build& build) {
    begin_docked("In hand", {0, 0, 312, static_cast<float>(picture.height)});
    ImGui::BeginChild("panel");
    build();
    ImGui::EndChild();
    ImGui::End();
  }

  std::optional<Gui> gui_;
};

}  // namespace prismesh::kiosk::panels
