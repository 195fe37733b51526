// One table of keys: no two meanings for one key, and docs/kiosk.md says the same.
#include "kiosk/tools/command.h"

#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include <gtest/gtest.h>

#include "kiosk/tools/mouse_layout.h"
#include "tests/support/places.h"

namespace prismesh::kiosk::tools {
namespace {

TEST(KeysTest, no_key_has_two_meanings) {
  std::set<std::tuple<int, bool, bool>> seen;
  for (const KeyBinding& binding : key_bindings())
    EXPECT_TRUE(seen.emplace(static_cast<int>(binding.key), binding.ctrl, binding.shift).second) << binding.label;
}

TEST(KeysTest, every_key_finds_its_command) {
  for (const KeyBinding& binding : key_bindings()) {
    const auto command = command_for(binding.key, {binding.shift, binding.ctrl, false});
    ASSERT_TRUE(command.has_value()) << binding.label;
    EXPECT_EQ(*command, binding.command) << binding.label;
  }
}

TEST(KeysTest, shift_tells_save_from_save_as_but_does_not_stop_a_plain_key) {
  EXPECT_EQ(command_for(display::letter('S'), {false, true, false}), Command::save);
  EXPECT_EQ(command_for(display::letter('S'), {true, true, false}), Command::save_as);
  EXPECT_EQ(command_for(display::letter('V'), {true, false, false}), Command::toggle_through);
  EXPECT_EQ(command_for(display::letter('R'), {true, false, false}), Command::region_by) << "Shift+R has a meaning of its own";
}

TEST(KeysTest, every_command_has_a_key_and_a_menu_entry_with_words) {
  std::set<Command> seen;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(seen.insert(binding.command).second) << binding.label << ": the command stands in the table twice";
    EXPECT_NE(binding.key, display::Key::none) << binding.meaning;
    EXPECT_FALSE(binding.label.empty()) << binding.meaning;
    EXPECT_FALSE(binding.meaning.empty()) << binding.label;
    EXPECT_LT(static_cast<std::size_t>(binding.menu), kMenuNames.size()) << binding.label;
  }
  EXPECT_EQ(seen.size(), kCommandCount) << "a command lacks its row";
}

TEST(KeysTest, what_edits_is_told_from_what_only_looks) {
  for (const KeyBinding& binding : key_bindings()) {
    const bool part_or_mesh = binding.menu == Menu::parts || binding.menu == Menu::mesh;
    const bool looks = binding.command == Command::quality_panel || binding.command == Command::next_error ||
                       binding.command == Command::previous_error || binding.command == Command::damaged_only;
    if (part_or_mesh) {
      EXPECT_EQ(asks_for_edit(binding.command), !looks) << binding.label;
    } else if (binding.menu == Menu::file || binding.menu == Menu::view || binding.menu == Menu::display || binding.menu == Menu::help) {
      EXPECT_FALSE(asks_for_edit(binding.command)) << binding.label;
    }
  }
  for (const Command command : {Command::undo, Command::redo, Command::expression, Command::grow, Command::region, Command::type_number})
    EXPECT_TRUE(asks_for_edit(command));
  for (const Command command : {Command::compare, Command::cancel, Command::outline_kind, Command::falloff})
    EXPECT_FALSE(asks_for_edit(command));
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
  EXPECT_FALSE(command_for(display::Key::f2, {}).has_value());
  EXPECT_FALSE(command_for(display::letter('G'), {false, true, false}).has_value());
  EXPECT_FALSE(command_for(display::letter('G'), {false, false, true}).has_value());
}

TEST(KeysTest, the_documentation_lists_every_key_and_gesture_as_the_program_has_them) {
  std::ifstream file(test::source_folder() / "docs/kiosk.md");
  ASSERT_TRUE(file.good());
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  for (const KeyBinding& binding : key_bindings()) {
    const std::string row = "| " + std::string(binding.label) + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md lacks the row\n" << row;
  }
  for (const MouseBinding& binding : default_mouse_layout().in_words()) {
    const std::string row = "| " + binding.gesture + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md lacks the row\n" << row;
  }
}

}  // namespace
}  // namespace prismesh::kiosk::tools
