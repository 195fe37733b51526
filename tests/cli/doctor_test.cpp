// The checks of `prismesh doctor` on machines that are made up.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/machine_checks.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest() {
    std::string name = (fs::temp_directory_path() / "prismesh-doctor-XXXXXX").string();
    machine_.root = ::mkdtemp(name.data());
    machine_.state_directory = machine_.root / "state";
    machine_.now_s = 1'800'000'000;
    machine_.clock_synchronized = true;
  }
  ~DoctorTest() override {
    std::error_code problem;
    fs::remove_all(machine_.root, problem);
  }
  void put(const std::string& path, const std::string& text = {}) const {
    fs::create_directories((machine_.root / path).parent_path());
    std::ofstream(machine_.root / path, std::ios::binary) << text;
  }
  static std::vector<Grade> grades(const std::vector<Finding>& findings) {
    std::vector<Grade> all;
    for (const Finding& finding : findings) all.push_back(finding.grade);
    return all;
  }

  Machine machine_;
};

/// An EDID of one block: a panel of 1920x1080 by the maker "ABC".
std::string edid_block() {
  std::string block("\x00\xff\xff\xff\xff\xff\xff\x00", 8);
  block += std::string("\x04\x43\x34\x12\x01\x00\x00\x00\x01\x20\x01\x04\xa5\x34\x1d\x78", 16);
  block.resize(54, '\0');
  block += std::string("\x02\x3a\x80\x18\x71\x38\x2d\x40\x58\x2c\x45\x00\x08\x22\x21\x00\x00\x1e", 18);
  block.resize(127, '\0');
  unsigned sum = 0;
  for (const char each : block) sum += static_cast<unsigned char>(each);
  block += static_cast<char>((256 - sum % 256) % 256);
  return block;
}

TEST_F(DoctorTest, wants_a_seat_manager_on_the_bare_screen) {
  EXPECT_THAT(grades(check_seat(machine_)), ElementsAre(Grade::bad));
  machine_.in_x11 = true;
  EXPECT_THAT(grades(check_seat(machine_)), ElementsAre(Grade::note));
  put("run/seatd.sock");
  EXPECT_THAT(grades(check_seat(machine_)), ElementsAre(Grade::good));
}

TEST_F(DoctorTest, names_a_monitor_and_demands_its_native_mode) {
  put("sys/class/drm/card0-DP-1/status", "connected\n");
  put("sys/class/drm/card0-DP-1/modes", "1920x1080\n1280x720\n");
  put("sys/class/drm/card0-DP-1/edid", edid_block());
  put("sys/class/drm/card0-DP-2/status", "disconnected\n");
  std::vector<Finding> found = check_displays(machine_);
  ASSERT_THAT(grades(found), ElementsAre(Grade::good)) << found.front().says;
  EXPECT_THAT(found[0].says, HasSubstr("ABC"));
  EXPECT_THAT(found[0].says, HasSubstr("1920x1080"));
  put("sys/class/drm/card0-DP-1/modes", "1280x720\n");
  found = check_displays(machine_);
  ASSERT_THAT(grades(found), ElementsAre(Grade::bad));
  EXPECT_THAT(found[0].to_do, HasSubstr("native mode"));
  put("sys/class/drm/card0-DP-1/edid", "broken");
  EXPECT_THAT(grades(check_displays(machine_)), ElementsAre(Grade::note));
}

TEST_F(DoctorTest, says_that_there_is_no_monitor_and_no_graphics_card) {
  EXPECT_THAT(grades(check_displays(machine_)), ElementsAre(Grade::bad));
  machine_.in_x11 = true;
  EXPECT_THAT(grades(check_displays(machine_)), ElementsAre(Grade::note)) << "X11 may know one";
  EXPECT_THAT(grades(check_graphics(machine_)), ElementsAre(Grade::bad));
  put("dev/dri/renderD128");
  EXPECT_THAT(grades(check_graphics(machine_)), ElementsAre(Grade::good));
}

TEST_F(DoctorTest, looks_for_the_ports_of_real_devices) {
  drivers::settings::StationSettings settings;
  EXPECT_THAT(grades(check_ports(machine_, settings)), ElementsAre(Grade::note, Grade::note));
  settings.eye_tracker.driver = drivers::settings::TrackerDriver::dynasight;
  settings.eye_tracker.port = "/dev/prismesh/ftdi-1";
  settings.prism_servo.driver = drivers::settings::ServoDriver::dynamixel;
  settings.prism_servo.simulated = true;
  std::vector<Finding> found = check_ports(machine_, settings);
  EXPECT_THAT(grades(found), ElementsAre(Grade::bad, Grade::note));
  EXPECT_THAT(found[0].says, HasSubstr("/dev/prismesh/ftdi-1 isn't there"));
  EXPECT_EQ(found[1].says, "simulated");
  put("dev/prismesh/ftdi-1");
  EXPECT_THAT(grades(check_ports(machine_, settings)), ElementsAre(Grade::good, Grade::note));
}

TEST_F(DoctorTest, judges_real_time_and_locked_memory) {
  machine_.max_realtime_priority = 0;
  machine_.max_locked_kb = 8192;
  EXPECT_THAT(grades(check_realtime(machine_)), ElementsAre(Grade::note, Grade::note));
  machine_.max_realtime_priority = 40;
  machine_.max_locked_kb.reset();
  EXPECT_THAT(grades(check_realtime(machine_)), ElementsAre(Grade::good, Grade::good));
}

TEST_F(DoctorTest, judges_the_clock) {
  EXPECT_THAT(grades(check_clock(machine_)), ElementsAre(Grade::good));
  machine_.clock_synchronized = false;
  EXPECT_THAT(grades(check_clock(machine_)), ElementsAre(Grade::note));
  machine_.now_s = 3600;
  const std::vector<Finding> found = check_clock(machine_);
  EXPECT_THAT(grades(found), ElementsAre(Grade::bad));
  EXPECT_THAT(found[0].says, HasSubstr("1970-01-01 01:00"));
}

TEST_F(DoctorTest, names_a_unit_that_is_missing) {
  EXPECT_THAT(grades(check_units(machine_)), ElementsAre(Grade::note)) << "none: a machine of a developer";
  for (const char* unit :
       {"prismesh.target", "prismesh-modeld.socket", "prismesh-modeld.service", "prismesh-deviced.socket", "prismesh-deviced.service",
        "prismesh-pen.socket", "prismesh-pen.service", "prismesh-import.socket", "prismesh-import@.service"})
    put(std::string("usr/lib/systemd/system/") + unit);
  std::vector<Finding> found = check_units(machine_);
  EXPECT_THAT(grades(found), ElementsAre(Grade::bad));
  EXPECT_EQ(found[0].says, "prismesh-kiosk.service is missing");
  put("etc/systemd/system/prismesh-kiosk.service");
  EXPECT_THAT(grades(check_units(machine_)), ElementsAre(Grade::good));
}

TEST_F(DoctorTest, looks_where_the_journals_will_be) {
  const std::vector<Finding> found = check_disk(machine_);
  EXPECT_THAT(found.at(0).says, HasSubstr("/state, "));
  machine_.state_directory = "/proc/prismesh";
  EXPECT_THAT(grades(check_disk(machine_)), ElementsAre(Grade::bad));
}

TEST_F(DoctorTest, ends_with_1_when_something_is_bad_and_prints_json) {
  const Outcome ran = prismesh({"--json", "doctor", "--runtime-dir", (machine_.root / "run").string(), "--state-dir", "/proc/prismesh"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.out, HasSubstr(R"({"what":"journals","grade":"bad","says":"/proc/prismesh)"));
  EXPECT_THAT(ran.out, HasSubstr(R"("what":"modeld","grade":"note")"));
}

}  // namespace
}  // namespace prismesh::cli
