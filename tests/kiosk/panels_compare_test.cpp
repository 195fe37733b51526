// The panel that chooses what to compare.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/panels/layout.h"
#include "kiosk/tools/comparison/compare_panel.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::comparison {
namespace {

class ComparePanel : public panels::GuiTest {
 protected:
  /// Shows the requested comparison, as the kiosk does.
  void lay_out() {
    gui_->layout(picture_, 0.016, [&] {
      in_dock(picture_, [&] {
        if (const auto wanted = compare_panel(facts_, entry_)) facts_.wish = *wanted;
      });
    });
  }
  void click(double x, double y) {
    gui_->feed(display::PointerMoved{x, y, {}});
    lay_out();
    for (const bool down : {true, false}) {
      gui_->feed(display::ButtonChanged{display::MouseButton::left, down, x, y, {}});
      lay_out();
    }
  }
  void press(display::Key key) {
    for (const bool down : {true, false}) {
      gui_->feed(display::KeyChanged{key, down, false, {}});
      lay_out();
    }
  }
  void type(const std::string& text) {
    gui_->feed(display::TextTyped{text});
    lay_out();
  }
  void leave_field() {
    click(picture_.width / 2.0, picture_.height / 2.0);
    for (int round = 0; round < 30; ++round) lay_out();  // the next click is another
  }
  /// Where the text fields of the panel are, from above.
  std::vector<double> fields() {
    std::vector<double> found;
    bool inside = false;
    for (double y = 60; y < picture_.height - 20; y += 4) {
      if (!gui_->on_panel(60, y)) break;
      const CompareWish before = facts_.wish;
      click(60, y);
      if (gui_->wants_keys() && !inside) found.push_back(y + 6);
      inside = gui_->wants_keys();
      press(display::Key::escape);
      leave_field();
      facts_.wish = before;
    }
    return found;
  }

  display::PixelSize picture_{900, 700};
  CompareFacts facts_;
  CompareEntry entry_;
};

TEST_F(ComparePanel, both_expressions_of_a_distance_are_taken_however_their_fields_are_left) {
  facts_.wish.field = "distance";
  for (int round = 0; round < 3; ++round) lay_out();
  const std::vector<double> at = fields();
  ASSERT_EQ(at.size(), 2U);
  click(60, at[0]);
  type("part:1");
  click(60, at[1]);
  type("part:2");
  leave_field();
  EXPECT_EQ(facts_.wish.from, "part:1");
  EXPECT_EQ(facts_.wish.to, "part:2");
  click(60, at[1]);
  type(",part:3");
  press(display::Key::enter);
  EXPECT_THAT(facts_.wish.to, testing::HasSubstr("part:3"));
}

TEST_F(ComparePanel, another_deck_is_named_by_its_path) {
  facts_.wish.field = "displacement";
  facts_.wish.against = "";
  for (int round = 0; round < 3; ++round) lay_out();
  const std::vector<double> at = fields();
  ASSERT_EQ(at.size(), 1U);
  click(60, at[0]);
  type("/decks/before.k");
  press(display::Key::enter);
  EXPECT_EQ(facts_.wish.against, "/decks/before.k");
}

}  // namespace
}  // namespace prismesh::kiosk::tools::comparison
