// One table of keys: no two meanings for one key, and docs/kiosk.md says the same.
#include "kiosk/tools/command.h"

#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include <gtest/gtest.h>

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
  EXPECT_EQ(command_for(display::letter('G'), {true, false, false}), Command::grow);
}

TEST(KeysTest, unknown_keys_and_keys_with_alt_do_nothing) {
  EXPECT_FALSE(command_for(display::letter('J'), {}).has_value());
  EXPECT_FALSE(command_for(display::letter('G'), {false, true, false}).has_value());
  EXPECT_FALSE(command_for(display::letter('G'), {false, false, true}).has_value());
}

TEST(KeysTest, the_documentation_lists_every_key_and_gesture_as_the_program_has_them) {
  std::ifstream file(std::string(PRISMESH_SOURCE_FOLDER) + "/docs/kiosk.md");
  ASSERT_TRUE(file.good());
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  for (const KeyBinding& binding : key_bindings()) {
    const std::string row = "| " + std::string(binding.label) + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md lacks the row\n" << row;
  }
  for (const MouseBinding& binding : mouse_bindings()) {
    const std::string row = "| " + std::string(binding.gesture) + " | " + std::string(binding.meaning) + " |";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/kiosk.md lacks the row\n" << row;
  }
}

}  // namespace
}  // namespace prismesh::kiosk::tools
