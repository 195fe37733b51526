// Display profiles by name, from files and back; a faulty file is refused with its line.
#include "drivers/display/profile.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh::drivers::display {
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

TEST_F(ProfileFile, sets_every_value) {
  const auto profile = read(
      "name = \"lab 2\"\nweave = \"mask\"\neye = \"right\"\nswap_eyes = true\nsubpixels = \"bgr\"\npixel_pitch_mm = 0.31\ngamma = 2.4\n"
      "eye_separation_mm = 61.5\n[mask]\nmoves = true\ndesign_distance_mm = 700\ndesign_separation_mm = 64\nrefractive_index = 1.49\n"
      "lean = -0.3333\nzero_mm = 0.042\npitch_scale = 1.0004\ngap_scale = 0.97\n[crosstalk]\nleft = 0.04\nright = 0.06\n"
      "[monitor]\nname = \"EIZO L568\"\nserial = \"0815\"\npixels = [1280, 1024]\n");
  ASSERT_TRUE(profile) << profile.error().text();
  EXPECT_EQ(profile->name, "lab 2");
  EXPECT_EQ(profile->weave, Weave::mask);
  EXPECT_EQ(profile->eye, Eye::right);
  EXPECT_TRUE(profile->swap_eyes);
  EXPECT_EQ(profile->subpixels, Subpixels::bgr);
  EXPECT_EQ(profile->gamma, 2.4);
  EXPECT_EQ(profile->eye_separation_mm, 61.5);
  EXPECT_TRUE(profile->mask_moves);
  MaskOptics optics{.pixel_pitch_mm = 0.31, .design_distance_mm = 700, .design_separation_mm = 64, .refractive_index = 1.49};
  optics.lean = -0.3333;
  optics.zero_mm = 0.042;
  optics.pitch_scale = 1.0004;
  optics.gap_scale = 0.97;
  EXPECT_EQ(profile->optics, optics);
  EXPECT_EQ(profile->crosstalk, (std::array<double, 2>{0.04, 0.06}));
  EXPECT_EQ(profile->monitor, (Monitor{"EIZO L568", "0815", {1280, 1024}}));
  EXPECT_DOUBLE_EQ(screen_size_mm(*profile, 1000, 500).x(), 310);
}

TEST_F(ProfileFile, keeps_the_defaults_of_missing_keys) {
  const auto profile = read("pixel_pitch_mm = 1\n");
  ASSERT_TRUE(profile) << profile.error().text();
  Profile wanted;
  wanted.name = std::filesystem::path(path_).stem().string();
  wanted.optics.pixel_pitch_mm = 1;
  EXPECT_EQ(*profile, wanted);
}

TEST_F(ProfileFile, refuses_errors_with_their_line) {
  struct Case {
    const char* text;
    long line;
    const char* says;
  };
  const Case wrong[] = {{"weave = \"columns\"\npixel_pich_mm = 3\n", 2, "the nearest known one is \"pixel_pitch_mm\""},
                        {"weave = \"zigzag\"\n", 1, "weave must be one of \"mask\", \"columns\""},
                        {"\npixel_pitch_mm = -1\n", 2, "pixel_pitch_mm must be a number from 0.01 to 10"},
                        {"pixel_pitch_mm = nan\n", 1, "a number from"},
                        {"eye = 5\n", 1, "one of \"left\", \"right\""},
                        {"name = \"a\"\n\nname = \"b\"\n", 3, ""},
                        {"swap_eyes = \n", 1, ""},
                        {"swap_eyes = 1\n", 1, "true or false"},
                        {"[mask]\n\nleen = 0.2\n", 3, "unknown key \"leen\" in [mask]; the nearest known one is \"lean\""},
                        {"lean = 0.2\n", 1, "\"lean\" belongs into [mask]"},
                        {"[mask]\ngamma = 2\n", 2, "\"gamma\" belongs before the first section"},
                        {"mask = 3\n", 1, "mask must be a section: [mask]"},
                        {"[mosk]\n", 1, "the nearest known one is \"mask\""},
                        {"[crosstalk]\nleft = 0.8\n", 2, "left in [crosstalk] must be a number from 0 to 0.5"},
                        {"[monitor]\npixels = [1920]\n", 2, "columns and rows"},
                        {"[monitor]\npixels = [1920, 1.5]\n", 2, "two whole numbers"},
                        {"[monitor]\npixels = [1920, -2]\n", 2, "two whole numbers"},
                        {"eye_separation_mm = 6.3\n", 1, "a number from 50 to 75"}};
  for (const Case& c : wrong) {
    const auto profile = read(c.text);
    ASSERT_FALSE(profile) << c.text;
    EXPECT_EQ(profile.error().line, c.line) << profile.error().text();
    EXPECT_EQ(profile.error().file, path_);
    EXPECT_NE(profile.error().message.find(c.says), std::string::npos) << profile.error().text();
  }
}

TEST_F(ProfileFile, reads_what_was_written) {
  Profile odd = built_in_profiles().front();
  odd.name = "quotes \" and \\ and\ttabs\x01 and B\xc3\xbcro";
  odd.swap_eyes = true;
  odd.eye_separation_mm = 61.123456789012345;
  odd.optics.zero_mm = -1.0 / 3e5;
  odd.optics.pitch_scale = 1.0000000000000002;
  odd.crosstalk = {0.031, 0.029};
  odd.monitor = {"DELL U2412M", "Y1H5T", {1920, 1200}};
  std::vector<Profile> all(built_in_profiles().begin(), built_in_profiles().end());
  all.push_back(odd);
  for (const Profile& profile : all) {
    const auto written = write_profile(path_, profile);
    ASSERT_TRUE(written) << written.error().text();
    const auto again = find_profile(path_);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(*again, profile) << profile.name;
  }
}

TEST_F(ProfileFile, is_not_written_if_it_could_not_be_read) {
  Profile broken = built_in_profiles().front();
  ASSERT_TRUE(write_profile(path_, broken));
  broken.optics.lean = 5;
  const auto lean = write_profile(path_, broken);
  ASSERT_FALSE(lean);
  EXPECT_NE(lean.error().message.find("lean in [mask] must be a number from -2 to 2"), std::string::npos) << lean.error().text();
  broken = built_in_profiles().front();
  broken.name = "\xff\xfe";
  EXPECT_FALSE(write_profile(path_, broken));
  EXPECT_EQ(*find_profile(path_), built_in_profiles().front()) << "what was there stays";
}

TEST(Profile, an_unknown_name_is_refused_with_the_known_ones) {
  const auto profile = find_profile("prism");
  ASSERT_FALSE(profile);
  for (const Profile& known : built_in_profiles()) {
    EXPECT_NE(profile.error().message.find(known.name), std::string::npos);
    EXPECT_EQ(*find_profile(known.name), known);
  }
}

}  // namespace
}  // namespace prismesh::drivers::display
