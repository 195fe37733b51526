// Display profiles by name and from files; a wrong file is refused with its line.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "kiosk/stereo/profile.h"

namespace prismesh::kiosk::stereo {
namespace {

class ProfileFile : public testing::Test {
 protected:
  ~ProfileFile() override { std::filesystem::remove(path_); }
  Result<Profile> read(const std::string& text) {
    std::ofstream(path_) << text;
    return find_profile(path_);
  }
  std::string path_ = testing::TempDir() + "prismesh_profile_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
};

TEST_F(ProfileFile, SaysHowTheDisplayWeaves) {
  const auto profile = read("name = \"wall\"\nweave = \"columns\"\npixel_pitch_mm = 0.31\nswap_eyes = true\neye = \"right\"\n");
  ASSERT_TRUE(profile) << profile.error().text();
  EXPECT_EQ(profile->name, "wall");
  EXPECT_EQ(profile->weave, Weave::columns);
  EXPECT_EQ(profile->eye, Eye::right);
  EXPECT_TRUE(profile->swap_eyes);
  EXPECT_DOUBLE_EQ(screen_size_mm(*profile, 1000, 500).x(), 310);
}

TEST_F(ProfileFile, IsRefusedWithItsLine) {
  const std::pair<const char*, long> wrong[] = {{"weave = \"columns\"\npitch = 3\n", 2}, {"weave = \"rows\"\n", 1},
                                                {"\npixel_pitch_mm = -1\n", 2},          {"eye = 5\n", 1},
                                                {"name = \"a\"\n\nname = \"b\"\n", 3},   {"swap_eyes = \n", 1}};
  for (const auto& [text, line] : wrong) {
    const auto profile = read(text);
    ASSERT_FALSE(profile) << text;
    EXPECT_EQ(profile.error().line, line) << profile.error().text();
    EXPECT_EQ(profile.error().file, path_);
  }
}

TEST(Profile, NamesAreListedWhenOneIsWrong) {
  const auto profile = find_profile("prism");
  ASSERT_FALSE(profile);
  for (const Profile& known : built_in_profiles()) {
    EXPECT_NE(profile.error().message.find(known.name), std::string::npos);
    EXPECT_EQ(find_profile(known.name)->name, known.name);
  }
}

}  // namespace
}  // namespace prismesh::kiosk::stereo
