#include "drivers/settings/choose_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "drivers/settings/settings.h"

namespace prismesh::drivers::settings {
namespace {

using testing::HasSubstr;

std::string changed(const std::string& text, const std::filesystem::path& profile = "/home/lab/wall.toml") {
  const Result<std::string> result = with_profile(text, "/etc/prismesh/prismesh.toml", profile);
  EXPECT_TRUE(result) << result.error().text();
  return result.value_or("");
}

TEST(ChooseProfile, changes_one_value_and_nothing_else) {
  EXPECT_EQ(
      changed("# our wall\n[display]\nlatency_ms = 7  # measured\n  profile = \"prism-mask\"  # was: mono\n\n[eye_tracker]\ndriver = "
              "\"none\"\n"),
      "# our wall\n[display]\nlatency_ms = 7  # measured\n  profile = \"/home/lab/wall.toml\"  # was: mono\n\n[eye_tracker]\ndriver = "
      "\"none\"\n");
  EXPECT_EQ(changed("[display]\r\nprofile='mono'\r\n"), "[display]\r\nprofile=\"/home/lab/wall.toml\"\r\n");
}

TEST(ChooseProfile, adds_the_key_or_the_section) {
  EXPECT_EQ(changed("[display]\nlatency_ms = 7\n"), "[display]\nprofile = \"/home/lab/wall.toml\"\nlatency_ms = 7\n");
  EXPECT_EQ(changed("[display]"), "[display]\nprofile = \"/home/lab/wall.toml\"\n");
  EXPECT_EQ(changed(""), "[display]\nprofile = \"/home/lab/wall.toml\"\n");
  EXPECT_EQ(changed("[eye_tracker]\ndriver = \"none\""),
            "[eye_tracker]\ndriver = \"none\"\n\n[display]\nprofile = \"/home/lab/wall.toml\"\n");
}

TEST(ChooseProfile, accepts_every_way_to_write_a_profile) {
  for (const char* profile : {"anaglyph", "wall.toml", "lab/wall.toml", "../wall.toml", "/home/lab/../wall.toml"})
    EXPECT_EQ(changed("", profile), std::string("[display]\nprofile = \"") + profile + "\"\n");
}

TEST(ChooseProfile, changes_a_file_whose_port_is_in_another_file) {
  const std::string driver = "[eye_tracker]\ndriver = \"dynasight\"\n";
  EXPECT_EQ(changed(driver), driver + "\n[display]\nprofile = \"/home/lab/wall.toml\"\n");
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "choose_profile_part";
  std::filesystem::create_directories(folder);
  const std::filesystem::path system = folder / "system.toml", user = folder / "user.toml";
  std::ofstream(system) << "[eye_tracker]\nport = \"/dev/a\"\n";
  std::ofstream(user) << driver;
  EXPECT_TRUE(choose_profile(user, "/home/lab/wall.toml"));
  EXPECT_EQ(read_settings({system, user}, std::nullopt)->display.profile, "/home/lab/wall.toml");
  std::filesystem::remove_all(folder);
}

TEST(ChooseProfile, writes_names_that_need_quoting) {
  const std::string odd = "/home/lab/a \"b\"\\c\td.toml";
  const Result<StationSettings> read = parse_settings(changed("", odd), "/etc/prismesh/prismesh.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->display.profile, odd);
}

TEST(ChooseProfile, refuses_a_text_that_it_cannot_change_safely) {
  for (const char* text : {"display = {profile = \"mono\"}\n", "display.profile = \"mono\"\n", "[display]\nprofile = \"\"\"\nmono\"\"\"\n",
                           "[\"display\"]\nprofile = \"mono\"\n"}) {
    const Result<std::string> result = with_profile(text, "/etc/prismesh/prismesh.toml", "/home/lab/wall.toml");
    EXPECT_FALSE(result) << text << "\n" << *result;
  }
}

TEST(ChooseProfile, creates_the_file_and_keeps_a_faulty_one) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "choose_profile";
  std::filesystem::remove_all(folder);
  const std::filesystem::path file = folder / "prismesh" / "prismesh.toml";
  ASSERT_TRUE(choose_profile(file, "/home/lab/wall.toml"));
  EXPECT_EQ(read_settings({file}, std::nullopt)->display.profile, "/home/lab/wall.toml");
  std::ofstream(file) << "[display\n";
  const Result<void> refused = choose_profile(file, "/home/lab/other.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 1);
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "[display\n");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace prismesh::drivers::settings
