// The tables of keys together: no two meanings for one key, and docs/kiosk.md says the same.
#include "kiosk/tool_list.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/input/mouse_layout.h"
#include "tests/support/places.h"

namespace prismesh::kiosk {
namespace {

using input::Command;
using input::KeyBinding;
using input::Menu;

/// The label of the row that a key finds; empty: it has none.
std::string_view row_of(display::Key key, const display::Modifiers& modifiers) {
  const KeyBinding* found = input::binding_for(key_bindings(), key, modifiers);
  return found != nullptr ? found->label : std::string_view();
}

const KeyBinding& row(std::string_view label) {
  const auto all = key_bindings();
  return *std::find_if(all.begin(), all.end(), [&](const KeyBinding& binding) { return binding.label == label; });
}

TEST(KeysTest, no_key_has_two_meanings) {
  std::set<std::tuple<int, bool, bool>> seen;
  for (const KeyBinding& binding : key_bindings())
    EXPECT_TRUE(seen.emplace(static_cast<int>(binding.key), binding.ctrl, binding.shift).second) << binding.label;
}

TEST(KeysTest, every_key_finds_its_command) {
  for (const KeyBinding& binding : key_bindings()) {
    const KeyBinding* found = input::binding_for(key_bindings(), binding.key, {binding.shift, binding.ctrl, false});
    ASSERT_NE(found, nullptr) << binding.label;
    EXPECT_EQ(found->command, binding.command) << binding.label;
  }
}

TEST(KeysTest, shift_tells_save_from_save_as_but_does_not_stop_a_plain_key) {
  EXPECT_EQ(row_of(display::letter('S'), {false, true, false}), "Ctrl+S");
  EXPECT_EQ(row_of(display::letter('S'), {true, true, false}), "Ctrl+Shift+S");
  EXPECT_EQ(row_of(display::letter('B'), {true, false, false}), "B");
  EXPECT_EQ(row_of(display::Key::escape, {}), "Esc");
  EXPECT_EQ(row_of(display::Key::escape, {true, false, false}), "Shift+Esc");
  EXPECT_EQ(row_of(display::letter('R'), {true, false, false}), "Shift+R") << "Shift+R has a meaning of its own";
}

TEST(KeysTest, every_command_has_one_row_with_words) {
  std::set<std::pair<std::string_view, int>> seen;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(seen.emplace(binding.command.owner, binding.command.number).second) << binding.label << ": the command has two rows";
    EXPECT_NE(binding.key, display::Key::none) << binding.meaning;
    EXPECT_FALSE(binding.label.empty()) << binding.meaning;
    EXPECT_FALSE(binding.meaning.empty()) << binding.label;
    EXPECT_LT(static_cast<std::size_t>(binding.menu), input::kMenuNames.size()) << binding.label;
  }
}

TEST(KeysTest, the_commands_of_an_owner_are_numbered_without_gaps) {
  std::map<std::string_view, std::set<int>> numbers;
  for (const KeyBinding& binding : key_bindings()) numbers[binding.command.owner].insert(binding.command.number);
  EXPECT_EQ(numbers.size(), 16U) << "fifteen tools and the editor";
  for (const auto& [owner, taken] : numbers)
    EXPECT_EQ(*taken.rbegin() + 1, static_cast<int>(taken.size())) << owner << ": a row is missing";
}

TEST(KeysTest, rows_keep_the_order_of_help_and_menu) {
  std::vector<std::string_view> labels;
  for (const KeyBinding& binding : key_bindings()) labels.push_back(binding.label);
  const std::vector<std::string_view> wanted{"Ctrl+O",
                                             "Ctrl+S",
                                             "Ctrl+Shift+S",
                                             "Ctrl+Shift+C",
                                             "Ctrl+Shift+W",
                                             "Ctrl+Q",
                                             "Ctrl+I",
                                             "Ctrl+Z",
                                             "Ctrl+Y",
                                             "C",
                                             "Shift+C",
                                             "Ctrl+C",
                                             "Ctrl+P",
                                             "Space",
                                             "Esc",
                                             "Shift+Esc",
                                             "F2",
                                             "E",
                                             "L",
                                             "V",
                                             "G",
                                             "B",
                                             "I",
                                             "R",
                                             "Shift+R",
                                             "Shift+PgUp",
                                             "Shift+PgDn",
                                             "W",
                                             "N",
                                             "Shift+N",
                                             "A",
                                             "Shift+A",
                                             "Shift+X",
                                             "Shift+Y",
                                             "Shift+Z",
                                             "Shift+D",
                                             "T",
                                             "Ctrl+Shift+R",
                                             "D",
                                             "Ctrl+Up",
                                             "Ctrl+Down",
                                             "Shift+G",
                                             "Ctrl+G",
                                             "Ctrl+Shift+G",
                                             "Shift+V",
                                             "Shift+F",
                                             "Shift+E",
                                             "Shift+I",
                                             "Shift+T",
                                             "M",
                                             "Shift+M",
                                             "Shift+W",
                                             "Ctrl+Shift+D",
                                             "J",
                                             "Right",
                                             "Left",
                                             "Shift+J",
                                             "Ctrl+L",
                                             "Ctrl+Shift+L",
                                             "Shift+L",
                                             "Ctrl+J",
                                             "Ctrl+E",
                                             "Ctrl+Shift+E",
                                             "Ctrl+Shift+J",
                                             "Ctrl+T",
                                             "Ctrl+Shift+T",
                                             "Ctrl+H",
                                             "Ctrl+K",
                                             "Ctrl+Right",
                                             "Ctrl+Left",
                                             "Ctrl+Shift+K",
                                             "F3",
                                             "Ctrl+D",
                                             "Ctrl+B",
                                             "Ctrl+M",
                                             "Ctrl+W",
                                             "Enter",
                                             "F7",
                                             "Shift+F7",
                                             "Ctrl+F7",
                                             "F8",
                                             "Shift+F8",
                                             "Ctrl+F8",
                                             "F4",
                                             "Shift+F4",
                                             "Ctrl+F4",
                                             "F6",
                                             "Shift+F6",
                                             "Ctrl+F6",
                                             "H",
                                             "O",
                                             "S",
                                             "U",
                                             "K",
                                             "Shift+U",
                                             "Shift+H",
                                             "Shift+O",
                                             "Shift+K",
                                             "F",
                                             "Ctrl+F",
                                             "1",
                                             "2",
                                             "3",
                                             "4",
                                             "5",
                                             "6",
                                             "7",
                                             "Q",
                                             "Y",
                                             "Shift+Q",
                                             "P",
                                             "Z",
                                             "X",
                                             "PgUp",
                                             "PgDn",
                                             "Ctrl+PgUp",
                                             "Ctrl+PgDn",
                                             "Ctrl+Shift+P",
                                             "F12",
                                             "Ctrl+R",
                                             "F11",
                                             "F10",
                                             "F1",
                                             "Shift+F1"};
  EXPECT_EQ(labels, wanted);
}

TEST(KeysTest, what_edits_is_told_from_what_only_looks) {
  const std::set<std::string_view> looks{"J",      "Right",    "Left",       "Shift+J",   "Ctrl+T",       "Ctrl+Shift+T",
                                         "Ctrl+H", "Ctrl+K",   "Ctrl+Right", "Ctrl+Left", "Ctrl+Shift+K", "F3",
                                         "F7",     "Shift+F7", "Ctrl+F7",    "F8",        "Shift+F8"};
  for (const KeyBinding& binding : key_bindings()) {
    const bool part_or_mesh = binding.menu == Menu::parts || binding.menu == Menu::mesh;
    if (part_or_mesh) {
      EXPECT_EQ(binding.asks_for_edit(), !looks.contains(binding.label)) << binding.label;
    } else if (binding.menu == Menu::file || binding.menu == Menu::view || binding.menu == Menu::display || binding.menu == Menu::help) {
      EXPECT_FALSE(binding.asks_for_edit()) << binding.label;
    }
  }
  for (const std::string_view label : {"Ctrl+Z", "Ctrl+Y", "E", "G", "B", "I", "R", "N"}) EXPECT_TRUE(row(label).asks_for_edit()) << label;
  for (const std::string_view label : {"C", "Esc", "Shift+Esc", "L", "D"}) EXPECT_FALSE(row(label).asks_for_edit()) << label;
}

TEST(KeysTest, a_key_held_down_repeats_what_goes_on_in_steps) {
  std::set<std::string_view> repeated;
  for (const KeyBinding& binding : key_bindings())
    if (binding.repeats()) repeated.insert(binding.label);
  EXPECT_EQ(repeated,
            (std::set<std::string_view>{"Ctrl+Z", "Ctrl+Y", "Right", "Left", "G", "B", "Shift+PgUp", "Shift+PgDn", "Ctrl+Up", "Ctrl+Down",
                                        "PgUp", "PgDn", "Ctrl+PgUp", "Ctrl+PgDn", "Ctrl+Right", "Ctrl+Left", "F8", "Shift+F8"}));
}

TEST(KeysTest, a_label_says_which_key_it_is) {
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_EQ(binding.label.find("Ctrl+") != std::string_view::npos, binding.ctrl) << binding.label;
    EXPECT_EQ(binding.label.find("Shift+") != std::string_view::npos, binding.shift) << binding.label;
    const std::string_view key = binding.label.substr(binding.label.rfind('+') + 1);
    if (key.size() == 1) {
      EXPECT_EQ(static_cast<int>(binding.key), key[0]) << binding.label;
    }
  }
}

TEST(KeysTest, unknown_keys_and_keys_with_alt_do_nothing) {
  EXPECT_EQ(row_of(display::Key::f9, {}), "");
  EXPECT_EQ(row_of(display::letter('Q'), {true, true, false}), "");
  EXPECT_EQ(row_of(display::letter('G'), {false, false, true}), "");
}

TEST(KeysTest, the_documentation_lists_every_key_and_gesture_as_the_program_has_them) {
  std::ifstream file(test::source_folder() / "docs/kiosk.md");
  ASSERT_TRUE(file.good());
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  for (const KeyBinding& binding : key_bindings()) {
    const std::string row = "| " + std::string(binding.label) + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md is missing the row\n" << row;
  }
  for (const input::MouseBinding& binding : input::default_mouse_layout().in_words()) {
    const std::string row = "| " + binding.gesture + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md is missing the row\n" << row;
  }
}

}  // namespace
}  // namespace prismesh::kiosk
