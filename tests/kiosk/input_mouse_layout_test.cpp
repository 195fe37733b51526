// Mouse layouts are data: the built-in ones can be used, one's own is refused with its line where it makes no sense.
#include "kiosk/input/mouse_layout.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace prismesh::kiosk::input {
namespace {

using display::Modifiers;
using display::MouseButton;

constexpr const char* kWhole =
    "[drag]\nleft = \"outline\"\nmiddle = \"orbit\"\n\"shift+middle\" = \"pan\"\n[click]\nleft = \"pick\"\n[wheel]\nwheel = \"zoom\"\n";

TEST(MouseLayoutTest, every_built_in_layout_can_be_used) {
  for (const MouseText& text : kMouseTexts) {
    const auto layout = find_mouse_layout(std::string(text.name));
    ASSERT_TRUE(layout) << layout.error().text();
    EXPECT_EQ(layout->drag(MouseButton::left, {}), DragDoes::outline) << text.name;
    EXPECT_EQ(layout->double_click(MouseButton::left, {}), ClickDoes::region) << text.name;
    EXPECT_GT(layout->in_words().size(), 10u);
  }
  EXPECT_EQ(default_mouse_layout().drag(MouseButton::right, {}), DragDoes::orbit);
  EXPECT_EQ(find_mouse_layout("middle-orbit")->drag(MouseButton::middle, {}), DragDoes::orbit);
  EXPECT_EQ(find_mouse_layout("middle-orbit")->drag(MouseButton::middle, {true, false, false}), DragDoes::pan);
  EXPECT_EQ(find_mouse_layout("ctrl-orbit")->drag(MouseButton::left, {false, true, false}), DragDoes::orbit);
}

TEST(MouseLayoutTest, modifiers_that_a_layout_doesnt_name_say_how_to_select) {
  const auto layout = MouseLayout::parse(kWhole, "hand.toml");
  ASSERT_TRUE(layout) << layout.error().text();
  EXPECT_EQ(layout->drag(MouseButton::left, {true, true, false}), DragDoes::outline);
  EXPECT_FALSE(layout->takes_modifiers(MouseButton::left, {true, true, false}));
  EXPECT_EQ(layout->drag(MouseButton::middle, {true, false, false}), DragDoes::pan);
  EXPECT_TRUE(layout->takes_modifiers(MouseButton::middle, {true, false, false}));
}

TEST(MouseLayoutTest, what_makes_no_sense_is_refused_with_its_line) {
  const auto refused = [](const std::string& text) {
    const auto layout = MouseLayout::parse(text, "hand.toml");
    return layout ? std::string("taken") : layout.error().text();
  };
  EXPECT_EQ(refused(std::string(kWhole) + "[drug]\n"), "hand.toml:9: a mouse layout has no section [drug]; the nearest known is [drag]");
  EXPECT_EQ(refused("[drag]\n\"ctrl+lft\" = \"orbit\"\n"),
            "hand.toml:2: \"ctrl+lft\" is no button; the nearest is \"left\", with alt+, ctrl+ or shift+ before it");
  EXPECT_EQ(refused("[drag]\n\nleft = \"orbits\"\n"), "hand.toml:3: \"left\" can't do that; the nearest is \"orbit\"");
  EXPECT_EQ(refused("[drag]\nleft = 3\n"), "hand.toml:2: \"left\" can't do that; name in quotes what it does");
  EXPECT_EQ(refused("[drag]\nleft = \"outline\"\n[click]\nleft = \"pick\"\n"),
            "hand.toml: no drag does \"orbit\": without it the hand is lost");
  EXPECT_NE(refused("[drag\n").find("hand.toml:1"), std::string::npos);
  EXPECT_NE(refused("").find("no drag"), std::string::npos);
}

TEST(MouseLayoutTest, a_layout_is_found_by_name_or_file) {
  const auto nothing = find_mouse_layout("midle-orbit");
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("\"middle-orbit\""), std::string::npos) << nothing.error().text();
  EXPECT_FALSE(find_mouse_layout("/no/such/hand.toml"));
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("hand-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << kWhole;
  EXPECT_TRUE(find_mouse_layout(file.string()));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace prismesh::kiosk::input
