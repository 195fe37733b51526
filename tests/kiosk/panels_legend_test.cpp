// Texts of a legend, and changing its limits with the mouse.
#include <algorithm>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/tools/comparison/legend.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::comparison {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

LegendFacts facts_of(double clear, double full) {
  LegendFacts facts;
  facts.look = {true, clear, full, render::ColourMap::crimson, 0};
  facts.min = -0.00002;
  facts.min_at = "shell:7";
  facts.max = 12.3456;
  facts.max_at = "shell:12";
  return facts;
}

TEST(Legend, names_the_value_that_is_farthest_toward_the_maps_end) {
  EXPECT_EQ(worst_words(facts_of(1, 5)), "most 12.35 at shell:12");
  EXPECT_EQ(worst_words(facts_of(0.5, 0)), "least -0.00002 at shell:7") << "small values are the coloured ones";
  LegendFacts even = facts_of(1, 5);
  even.min = even.max = 0;
  EXPECT_EQ(worst_words(even), "0 everywhere");
}

TEST(Legend, says_what_the_colours_do_not_show) {
  LegendFacts facts = facts_of(1, 5);
  EXPECT_THAT(legend_notes(facts), IsEmpty());
  facts.shells_without = 1;
  EXPECT_THAT(legend_notes(facts), ElementsAre("1 shell without a value"));
  facts.new_nodes = 3;
  facts.before_pull = true;
  EXPECT_THAT(legend_notes(facts), ElementsAre(HasSubstr("before this pull"), HasSubstr("3 new nodes"), "1 shell without a value"));
}

TEST(Legend, says_the_value_under_the_pointer) {
  LegendFacts facts = facts_of(1, 5);
  facts.unit = "mm";
  EXPECT_EQ(probe_words(facts), "") << "nothing is there";
  facts.probed_at = "node 12";
  EXPECT_EQ(probe_words(facts), "node 12: no value");
  facts.probed = 2.34567;
  EXPECT_EQ(probe_words(facts), "node 12: 2.346 mm");
}

TEST(Legend, all_values_lie_between_the_limits_taken_from_them) {
  const auto limits = limits_of_values(facts_of(1, 5));
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->clear, -0.00002);
  EXPECT_EQ(limits->full, 12.3456);
  const auto small_is_worse = limits_of_values(facts_of(0.5, 0));
  ASSERT_TRUE(small_is_worse);
  EXPECT_EQ(small_is_worse->clear, 12.3456);
  EXPECT_EQ(small_is_worse->full, -0.00002);
  LegendFacts even = facts_of(1, 5);
  even.min = even.max;
  EXPECT_FALSE(limits_of_values(even)) << "no two limits";
}

TEST(Legend, ticks_are_round_numbers_from_one_limit_to_the_other) {
  const auto between = [](double clear, double full) { return ticks(facts_of(clear, full).look); };
  const auto near = [](std::initializer_list<double> wanted) {
    return testing::Pointwise(testing::DoubleNear(1e-12), std::vector(wanted));
  };
  EXPECT_THAT(between(1, 5), near({1, 2, 3, 4, 5}));
  EXPECT_THAT(between(0.5, 0), near({0.5, 0.4, 0.3, 0.2, 0.1, 0})) << "small values are the coloured ones";
  EXPECT_THAT(between(-0.00002, 12.3456), near({0, 5, 10}));
  EXPECT_THAT(between(3, 3), IsEmpty());
  EXPECT_THAT(between(0, std::numeric_limits<double>::infinity()), IsEmpty());
  for (double full = 1e-6; full < 1e7; full *= 1.37) {
    const std::size_t count = between(0, full).size();
    EXPECT_GE(count, 3U) << full;
    EXPECT_LE(count, 8U) << full;
  }
}

constexpr display::PixelSize kLegendPicture{1000, 640};

class LegendByHand : public panels::GuiTest {
 protected:
  void SetUp() override {
    panels::GuiTest::SetUp();
    if (HasFatalFailure() || IsSkipped()) return;
    facts_.pane = 0;
    for (int round = 0; round < 3; ++round) lay_out();
  }
  /// Applies the requested limits to the legend, as the kiosk does.
  bool lay_out() {
    std::optional<SetLimits> wanted;
    panels::PanelLayout layout{kLegendPicture};
    gui_->layout(kLegendPicture, 0.016, [&] { wanted = legend(facts_, layout).wanted; });
    items_ = layout.items;
    if (wanted) facts_.look.clear = wanted->clear, facts_.look.full = wanted->full;
    return wanted.has_value();
  }
  void move(double x, double y) {
    gui_->feed(display::PointerMoved{x, y, {}});
    lay_out();
  }
  void button(bool down, double x, double y) {
    gui_->feed(display::ButtonChanged{display::MouseButton::left, down, x, y, {}});
    lay_out();
  }
  /// Drags by so many pixels, from wherever in a column of the legend that has an effect.
  void drag_in_column(double x, double by) {
    const render::FieldLook before = facts_.look;
    for (double y = kLegendPicture.height - 150; y < kLegendPicture.height && facts_.look == before; y += 8) {
      move(x, y);
      button(true, x, y);
      for (int step = 1; step <= 5; ++step) move(x + by * step / 5, y);
      row_ = y;
      button(false, x + by, y);
    }
  }
  void press(display::Key key) {
    for (const bool down : {true, false}) {
      gui_->feed(display::KeyChanged{key, down, false, {}});
      lay_out();
    }
  }
  double left() const { return kLegendPicture.width / 2.0 - 130; }
  double right() const { return kLegendPicture.width / 2.0 + 130; }

  LegendFacts facts_ = facts_of(1, 5);
  double row_ = 0;
  std::vector<panels::ScreenItem> items_;  ///< of the last layout
};

TEST_F(LegendByHand, each_limit_is_dragged) {
  drag_in_column(left(), -60);
  EXPECT_LT(facts_.look.clear, 0.9);
  EXPECT_EQ(facts_.look.full, 5);
  drag_in_column(right(), 60);
  EXPECT_GT(facts_.look.full, 5.1);
}

TEST_F(LegendByHand, a_button_spreads_the_map_over_all_values) {
  const auto button_item = std::ranges::find(items_, "legend all values", &panels::ScreenItem::name);
  ASSERT_NE(button_item, items_.end());
  const double x = button_item->place.x + button_item->place.width / 2, y = button_item->place.y + button_item->place.height / 2;
  move(x, y);
  button(true, x, y);
  button(false, x, y);
  EXPECT_EQ(facts_.look.clear, facts_.min);
  EXPECT_EQ(facts_.look.full, facts_.max);
}

TEST_F(LegendByHand, a_limit_is_typed_after_a_double_click_and_read_again_as_it_was_typed) {
  drag_in_column(left(), -30);  // finds the row
  for (const char* typed : {"0.00005", "0.25"}) {
    move(left(), row_);
    for (const bool down : {true, false, true, false}) button(down, left(), row_);
    lay_out();
    ASSERT_TRUE(gui_->wants_keys()) << "a field takes the keyboard";
    gui_->feed(display::TextTyped{typed});
    lay_out();
    press(display::Key::enter);
    EXPECT_EQ(facts_.look.clear, std::stod(typed));
    for (int round = 0; round < 30; ++round) lay_out();  // the next clicks are others
    EXPECT_FALSE(gui_->wants_keys());
  }
}

}  // namespace
}  // namespace prismesh::kiosk::tools::comparison
