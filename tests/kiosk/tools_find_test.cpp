// Finding commands and ids by what is typed.
#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/tool_list.h"
#include "kiosk/tools/find/find_box.h"
#include "kiosk/tools/find/find_commands.h"
#include "kiosk/tools/find/typed_id.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::find {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = TypedId::Kind;

std::vector<std::string> labels(std::string_view words, const std::vector<std::string>& earlier = {}, std::size_t limit = 3) {
  std::vector<std::string> found;
  for (const std::size_t i : find_commands(words, key_bindings(), earlier, limit)) found.emplace_back(key_bindings()[i].label);
  return found;
}

TEST(FindCommands, every_command_is_found_by_its_own_words_and_by_its_key) {
  for (const input::KeyBinding& binding : key_bindings()) {
    EXPECT_EQ(labels(binding.meaning, {}, 1), std::vector{std::string(binding.label)}) << binding.meaning;
    EXPECT_THAT(labels(binding.label, {}, 200), testing::Contains(std::string(binding.label)));
  }
}

TEST(FindCommands, words_in_any_order_and_their_beginnings_are_enough) {
  EXPECT_EQ(labels("undo").front(), "Ctrl+Z");
  EXPECT_EQ(labels("parts SHOW all").front(), "S");
  EXPECT_EQ(labels("mirr").front(), "M");
  EXPECT_THAT(labels("axis turn"), testing::Contains("A"));
  EXPECT_THAT(labels("save cop"), ElementsAre("Ctrl+Shift+C"));
  EXPECT_THAT(labels("rotate"), testing::Contains("A")) << "the word of other programs";
  EXPECT_THAT(labels("penetration"), testing::Contains("Ctrl+K"));
  for (const char* word : {"translate", "move", "morph", "radius", "symmetry", "intersection", "smooth", "fix", "isolate", "blank",
                           "unblank", "zoom", "stereo", "diff"})
    EXPECT_THAT(labels(word), testing::Not(IsEmpty())) << word;
  EXPECT_THAT(labels("xyzzy"), IsEmpty());
  EXPECT_THAT(labels("undo xyzzy"), IsEmpty()) << "all words count";
}

TEST(FindCommands, without_words_what_was_used_last_comes_first) {
  const auto meaning = [](const std::string& label) {
    return std::string(std::ranges::find(key_bindings(), label, &input::KeyBinding::label)->meaning);
  };
  EXPECT_THAT(labels("", {meaning("M"), meaning("Ctrl+L")}, 2), ElementsAre("Ctrl+L", "M"));
  EXPECT_EQ(labels("   ", {}, 500).size(), key_bindings().size());
}

TEST(FindCommands, a_word_is_weighed_by_where_it_stands) {
  EXPECT_GT(fit_of("und", "undo the last"), fit_of("und", "what is under"));
  EXPECT_GT(fit_of("axis", "no axis: lift"), fit_of("axi", "no maxima"));
  EXPECT_EQ(fit_of("\xff", "plain"), 0);
  EXPECT_GT(fit_of("", ""), 0);
}

TEST(TypedIds, are_told_from_words) {
  const auto id = [](Kind kind, std::int64_t number) { return std::optional(TypedId{kind, number}); };
  EXPECT_EQ(typed_id("5000766"), id(Kind::any, 5000766));
  EXPECT_EQ(typed_id("  node 17 "), id(Kind::node, 17));
  EXPECT_EQ(typed_id("n17"), id(Kind::node, 17));
  EXPECT_EQ(typed_id("Shell:12"), id(Kind::shell, 12));
  EXPECT_EQ(typed_id("element #12"), id(Kind::shell, 12));
  EXPECT_EQ(typed_id("P3"), id(Kind::part, 3));
  EXPECT_EQ(typed_id("9223372036854775807"), id(Kind::any, 9223372036854775807));
  for (const char* no : {"", " ", "node", "12 13", "1.5", "-3", "part", "f10", "9223372036854775808", "12x", "\xff\xfe", "ctrl+1"})
    EXPECT_EQ(typed_id(no), std::nullopt) << no;
}

class FindBox : public panels::GuiTest {
 protected:
  std::optional<std::size_t> lay_out() {
    panels::PanelLayout layout{{1000, 640}};
    std::optional<std::size_t> taken;
    gui_->layout(layout.picture, 0.016, [&] { taken = find_box(facts_, opened_, entry_, layout); });
    opened_ = false;
    items_ = std::move(layout.items);
    return taken;
  }
  std::optional<std::size_t> press(display::Key key) {
    gui_->feed(display::KeyChanged{key, true, false, {}});
    const auto down = lay_out();
    gui_->feed(display::KeyChanged{key, false, false, {}});
    const auto up = lay_out();
    return down ? down : up;
  }
  FindFacts facts_{{{"node 17", "go there"}, {"Edit: undo", "Ctrl+Z"}, {"Edit: redo \xff", "Ctrl+Y"}}, ""};
  FindEntry entry_;
  bool opened_ = true;
  std::vector<panels::ScreenItem> items_;
};

TEST_F(FindBox, takes_the_chosen_row_by_enter_and_any_row_by_a_click) {
  for (int round = 0; round < 4; ++round) lay_out();
  ASSERT_TRUE(gui_->wants_keys()) << "one types at once";
  gui_->feed(display::TextTyped{"1"});
  lay_out();
  EXPECT_EQ(entry_.typed, "1");
  EXPECT_EQ(press(display::Key::enter), std::optional<std::size_t>(0));
  opened_ = true;
  for (int round = 0; round < 4; ++round) lay_out();
  press(display::Key::down);
  press(display::Key::down);
  EXPECT_EQ(entry_.chosen, 2U);
  press(display::Key::down);
  EXPECT_EQ(entry_.chosen, 0U) << "from the last to the first";
  press(display::Key::up);
  EXPECT_EQ(press(display::Key::enter), std::optional<std::size_t>(2));
  for (int round = 0; round < 4; ++round) lay_out();
  const auto row = std::ranges::find(items_, "found Edit: undo", &panels::ScreenItem::name);
  ASSERT_NE(row, items_.end());
  const double x = row->place.x + 20, y = row->place.y + 4;
  gui_->feed(display::PointerMoved{x, y, {}});
  lay_out();
  gui_->feed(display::ButtonChanged{display::MouseButton::left, true, x, y, {}});
  lay_out();
  gui_->feed(display::ButtonChanged{display::MouseButton::left, false, x, y, {}});
  EXPECT_EQ(lay_out(), std::optional<std::size_t>(1));
}

TEST_F(FindBox, says_why_nothing_is_found) {
  facts_ = {{}, "No command and no part has all of these words."};
  for (int round = 0; round < 4; ++round) lay_out();
  EXPECT_EQ(press(display::Key::enter), std::nullopt);
  press(display::Key::down);
}

}  // namespace
}  // namespace prismesh::kiosk::tools::find
