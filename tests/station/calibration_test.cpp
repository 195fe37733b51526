// The calibration as whole processes: a daemon with a simulated servo, the kiosk's wizard by keyboard, and what is on disk afterwards.
#include <cmath>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/display/profile.h"
#include "drivers/settings/settings.h"
#include "ipc/device/client.h"
#include "tests/station/station.h"

namespace prismesh::test {
namespace {

using drivers::prism_servo::MaskPhase;
using testing::HasSubstr;

constexpr const char* kSettings =
    "# of this laboratory\n[display]\nprofile = 'prism-mask'  # chosen by hand\n[prism_servo]\ndriver = 'dynamixel'\nsimulated = true\n";

class CalibrationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
    station_->set_picture_size(640, 480);
    station_->start_device_daemon(kSettings);
    ASSERT_TRUE(wait_for_daemon());
    station_->start_calibration();
  }

  bool wait_for_daemon() {
    for (int tries = 0; tries < 600; ++tries, ::usleep(50'000))
      if (auto client = ipc::DeviceClient::connect(ipc::device_socket_path(station_->folder() / "run"), "test"); client) {
        devices_.emplace(std::move(*client));
        return true;
      }
    return false;
  }
  /// Within a minute.
  template <class Condition>
  bool mask_gets(const Condition& condition) {
    for (int tries = 0; tries < 3000; ++tries, ::usleep(20'000))
      if (const auto mask = devices_->page().prism(); mask && condition(*mask)) return true;
    return false;
  }
  bool mask_is_held_at(double mm) {
    return mask_gets([&](const auto& mask) { return mask.phase == MaskPhase::held && std::abs(mask.position_mm - mm) < 0.01; });
  }

  void keys(const char* name, int times = 1) {
    for (int i = 0; i < times; ++i) station_->key(name);
  }
  /// Goes on, and waits for a line of the trace.
  bool next(const std::string& shown) {
    keys("Return");
    return !station_->kiosk().wait_for(shown).empty();
  }
  bool turn(const char* key, int coarse, int fine, const std::string& shown) {
    keys((std::string("shift+") + key).c_str(), coarse);
    keys(key, fine);
    return !station_->kiosk().wait_for(shown).empty();
  }
  std::filesystem::path settings_file() const { return station_->folder() / "prismesh.toml"; }
  std::string settings_text() const {
    std::stringstream text;
    text << std::ifstream(settings_file()).rdbuf();
    return text.str();
  }
  std::string daemons_profile() {
    const auto answer = devices_->call(ipc::GetDevices{});
    const auto* devices = answer ? std::get_if<ipc::Devices>(&*answer) : nullptr;
    return devices != nullptr ? devices->profile : std::string();
  }

  std::unique_ptr<Station> station_;
  std::optional<ipc::DeviceClient> devices_;
};

TEST_F(CalibrationTest, leads_by_keyboard_to_a_profile_that_everybody_uses) {
  ASSERT_TRUE(next("calibration 2 The size of a pixel"));
  ASSERT_TRUE(next("calibration 3 The distance of your eyes 63.0"));
  ASSERT_TRUE(turn("Left", 0, 2, "calibration 3 The distance of your eyes 62.0"));
  ASSERT_TRUE(next("calibration 4 The mask's pitch +0.000"));
  EXPECT_TRUE(mask_is_held_at(0));
  ASSERT_TRUE(turn("Right", 1, 2, "calibration 4 The mask's pitch +0.020"));
  ASSERT_TRUE(turn("Left", 1, 2, "calibration 4 The mask's pitch +0.000"));
  ASSERT_TRUE(next("calibration 5 The mask's place +0.000"));
  // Five places of the head. Nobody is seen, so the viewer is taken to sit as told: the mask belongs where the optics have it.
  keys("Return");
  ASSERT_TRUE(turn("Right", 3, 3, "calibration 5 The mask's place +0.157"));
  ASSERT_TRUE(mask_is_held_at(0.157));
  keys("Return");
  ASSERT_TRUE(turn("Left", 6, 6, "calibration 5 The mask's place -0.157"));
  ASSERT_TRUE(mask_is_held_at(-0.157));
  keys("Return");
  ASSERT_TRUE(turn("Right", 3, 3, "calibration 5 The mask's place +0.000"));
  ASSERT_TRUE(mask_is_held_at(0));
  keys("Return");
  ASSERT_TRUE(next("calibration 6 What shines through to the left eye 0.00"));
  EXPECT_TRUE(mask_gets([](const auto& mask) { return mask.phase != MaskPhase::held; })) << "it follows again";
  ASSERT_TRUE(turn("Right", 0, 4, "calibration 6 What shines through to the left eye 1.00"));
  ASSERT_TRUE(next("calibration 7 What shines through to the right eye 0.00"));
  ASSERT_TRUE(next("calibration 8 A last look"));
  EXPECT_EQ(settings_text(), kSettings) << "nothing is saved before the end";
  ASSERT_TRUE(next("calibration saved "));
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0) << station_->kiosk().standard_error();

  const std::filesystem::path file = station_->folder() / "config" / "prismesh" / "displays" / "prism-mask-calibrated.toml";
  const auto profile = drivers::display::find_profile(file.string());
  ASSERT_TRUE(profile) << profile.error().text();
  EXPECT_EQ(profile->eye_separation_mm, 62);
  EXPECT_NEAR(profile->crosstalk[0], 0.01, 1e-9);
  EXPECT_NEAR(profile->optics.zero_mm, 0, 0.02);
  EXPECT_NEAR(profile->optics.gap_scale, 1, 0.03);
  const auto settings = drivers::settings::read_settings({}, settings_file());
  ASSERT_TRUE(settings) << settings.error().text();
  EXPECT_EQ(std::filesystem::path(settings->display.profile), file);
  EXPECT_THAT(settings_text(), HasSubstr("# of this laboratory"));
  EXPECT_EQ(daemons_profile(), "prism-mask-calibrated");
}

TEST_F(CalibrationTest, left_by_escape_saves_nothing_and_lets_the_mask_go) {
  for (const char* page : {"calibration 2 ", "calibration 3 ", "calibration 4 "}) ASSERT_TRUE(next(page));
  ASSERT_TRUE(mask_is_held_at(0));
  keys("Escape");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0) << station_->kiosk().standard_error();
  EXPECT_TRUE(mask_gets([](const auto& mask) { return mask.phase != MaskPhase::held; }));
  EXPECT_EQ(settings_text(), kSettings);
  EXPECT_FALSE(std::filesystem::exists(station_->folder() / "config" / "prismesh" / "displays"));
  EXPECT_EQ(daemons_profile(), "prism-mask");
}

TEST_F(CalibrationTest, killed_lets_the_mask_go) {
  for (const char* page : {"calibration 2 ", "calibration 3 ", "calibration 4 "}) ASSERT_TRUE(next(page));
  ASSERT_TRUE(mask_is_held_at(0));
  station_->kiosk().kill(9);
  station_->kiosk().wait_for_exit();
  EXPECT_TRUE(mask_gets([](const auto& mask) { return mask.phase != MaskPhase::held; }));
}

}  // namespace
}  // namespace prismesh::test
