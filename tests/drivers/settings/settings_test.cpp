#include "drivers/settings/settings.h"
#include "tests/support/places.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::drivers::settings {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string error_of(std::string_view text) {
  const Result<StationSettings> settings = parse_settings(text, "station.toml");
  return settings ? "accepted" : settings.error().text();
}

StationSettings parsed(std::string_view text) {
  Result<StationSettings> settings = parse_settings(text, "station.toml");
  EXPECT_TRUE(settings) << settings.error().text();
  return settings ? *settings : StationSettings{};
}

/// All settings of a file as text, for comparison.
std::string all_of(const StationSettings& settings) {
  const EyeTrackerSettings& t = settings.eye_tracker;
  const PrismServoSettings& s = settings.prism_servo;
  std::ostringstream text;
  text << settings.display.profile << '|' << settings.display.latency_ms << '|' << int(settings.display.screen)
       << settings.display.connector << '|' << settings.display.mode.width << ' ' << settings.display.mode.height << ' '
       << settings.display.mode.refresh_hz << '|' << settings.display.console_switching << '|' << settings.display.video_memory_mb << '|'
       << int(t.driver) << '|' << t.simulated << '|' << t.port << '|' << t.baud << '|' << int(t.dialect) << '|' << t.polled << '|'
       << t.udp_port << '|' << t.latency_ms << '|' << t.noise_mm << '|' << t.offset_mm.x() << ' ' << t.offset_mm.y() << ' '
       << t.offset_mm.z() << '|' << t.eye_separation_mm << '|' << t.motion << '|' << int(s.driver) << '|' << s.simulated << '|' << s.port
       << '|' << s.baud << '|' << s.id << '|' << s.travel_mm_per_turn << '|' << s.reversed << '|' << s.zero_ticks << '|' << s.travel_mm
       << '|' << s.speed_mm_s << '|' << s.lag_ms << '|' << settings.hand.mouse << '|' << settings.document.history_mb << '|'
       << settings.document.hang_s;
  const HapticPenSettings& p = settings.haptic_pen;
  text << '|' << int(p.driver) << p.port << '|' << p.max_newton << '|' << p.stiffness_newton_m << '|' << p.friction << '|'
       << p.damping_newton_s_m << '|' << p.workspace_scale << '|' << p.left_handed << '|' << p.hand_script << '|' << p.firmware << '|'
       << p.force_scale << '|' << p.own_damping_newton_s_m << '|' << p.own_friction_newton << '|' << p.service_port;
  const RemoteSettings& r = settings.remote;
  text << '|' << r.address << '|' << r.port << '|' << r.hosts.size() << '|' << r.quota_gb << '|' << r.file_gb << '|' << r.reserved_gb << '|'
       << r.upload_hours;
  const ExhibitionSettings& e = settings.exhibition;
  text << '|' << e.deck << '|' << e.show << '|' << e.idle_s << '|' << e.warning_s << '|' << e.pin;
  return text.str();
}

constexpr char kEveryKey[] = R"(
[display]
profile = "anaglyph"
latency_ms = 6.5
screen = "bare"
connector = "DP-1"
mode = "1920x1080@60"
console_switching = true
video_memory_mb = 256
[hand]
mouse = "middle-orbit"
[document]
history_mb = 64
hang_s = 30
[eye_tracker]
driver = "dynasight"
simulated = true
port = "/dev/serial/by-id/usb-tracker"
baud = 9600
dialect = "dynasight"
polled = true
udp_port = 4243
latency_ms = 12.5
noise_mm = 0.5
offset_mm = [1, 210.5, -15]
eye_separation_mm = 61
motion = "lean"
[prism_servo]
driver = "dynamixel"
simulated = true
port = "/dev/serial/by-id/usb-servo"
baud = 57600
id = 7
travel_mm_per_turn = 4
reversed = true
zero_ticks = 1000
travel_mm = 1.5
speed_mm_s = 6
lag_ms = 20
[haptic_pen]
driver = "simulated"
port = "/dev/pts/9"
hand_script = "push.hand"
max_newton = 6
stiffness_newton_m = 500
friction = 0.1
damping_newton_s_m = 0.4
workspace_scale = 2.5
hand = "left"
firmware = "falcon.bin"
force_scale = 0.9
own_damping_newton_s_m = 0.7
own_friction_newton = 0.2
service_port = 8500
[remote]
listen = "[::1]:7443"
hosts = ["station.example", "Station"]
quota_gb = 20
file_gb = 4
reserved_gb = 1
upload_hours = 48
[exhibition]
deck = "/srv/show/sample.k"
show = "show.jsonl"
idle_s = 40
warning_s = 5
pin = "$6$saltsalt$hash-as-crypt-writes-it"
)";

TEST(Settings, an_empty_file_keeps_every_default) { EXPECT_EQ(all_of(parsed("")), all_of(StationSettings{})); }

TEST(Settings, every_key_is_read) {
  EXPECT_EQ(all_of(parsed(kEveryKey)),
            "anaglyph|6.5|2DP-1|1920 1080 60|1|256|1|1|/dev/serial/by-id/usb-tracker|9600|0|1|4243|12.5|0.5|1 210.5 -15|61|lean|"
            "1|1|/dev/serial/by-id/usb-servo|57600|7|4|1|1000|1.5|6|20|middle-orbit|64|30|1/dev/pts/"
            "9|6|500|0.1|0.4|2.5|1|push.hand|falcon.bin|0.9|0.7|0.2|8500|::1|7443|2|20|4|1|48|/srv/show/"
            "sample.k|show.jsonl|40|5|$6$saltsalt$hash-as-crypt-writes-it");
}

TEST(Settings, names_choose_drivers_and_dialects) {
  EXPECT_EQ(parsed("[eye_tracker]\ndriver = 'opentrack'").eye_tracker.driver, TrackerDriver::opentrack);
  EXPECT_EQ(parsed("[eye_tracker]\ndriver = 'none'").eye_tracker.driver, TrackerDriver::none);
  EXPECT_EQ(parsed("[eye_tracker]\ndialect = 'd4d'").eye_tracker.dialect, TrackerDialect::d4d);
  for (const char* motion : {"still", "sway", "lean", "turn", "tour"})
    EXPECT_EQ(parsed("[eye_tracker]\nmotion = '" + std::string(motion) + "'").eye_tracker.motion, motion);
}

TEST(Settings, refuses_errors_with_line_and_remedy) {
  const std::pair<const char*, const char*> cases[] = {
      {"[eye_traker]\n", "station.toml:1: settings have no section [eye_traker]; the nearest known is [eye_tracker]"},
      {"\nprofile = 'mono'\n", "station.toml:2: settings have no section [profile]"},
      {"display = 3\n", "station.toml:1: display must be a section, like [display]"},
      {"[display]\n\nprofil = 'mono'\n", "station.toml:3: [display] has no \"profil\"; the nearest known is \"profile\""},
      {"[prism_servo]\nbuad = 57600\n", "station.toml:2: [prism_servo] has no \"buad\"; the nearest known is \"baud\""},
      {"[eye_tracker]\ndriver = 'dynasite'\n",
       "station.toml:2: eye_tracker.driver has no \"dynasite\"; the nearest is \"dynasight\" of none, dynasight, opentrack"},
      {"[eye_tracker]\ndriver = 1\n", "station.toml:2: eye_tracker.driver must be one of none, dynasight, opentrack"},
      {"[eye_tracker]\nsimulated = 1\n", "station.toml:2: eye_tracker.simulated must be true or false"},
      {"[eye_tracker]\nport = 'ttyUSB0'\n",
       "station.toml:2: eye_tracker.port must be a device's whole path, like \"/dev/serial/by-id/..\""},
      {"[eye_tracker]\nudp_port = 65536\n", "station.toml:2: eye_tracker.udp_port is 65536; it must be from 1 to 65535"},
      {"[eye_tracker]\nudp_port = 4242.0\n", "station.toml:2: eye_tracker.udp_port must be a whole number"},
      {"[display]\nscreen = \"wayland\"\n",
       "station.toml:2: display.screen has no \"wayland\"; the nearest is \"usual\" of usual, x11, bare"},
      {"[display]\nmode = \"1920x\"\n", "station.toml:2: display.mode must be a mode in quotes, like \"1920x1080\" or \"1920x1080@60\""},
      {"[display]\nmode = \"1920x1080@\"\n",
       "station.toml:2: display.mode must be a mode in quotes, like \"1920x1080\" or \"1920x1080@60\""},
      {"[display]\nmode = \"1920x1080@nan\"\n",
       "station.toml:2: display.mode must be a mode in quotes, like \"1920x1080\" or \"1920x1080@60\""},
      {"[display]\nmode = \"-1x5\"\n", "station.toml:2: display.mode must be a mode in quotes, like \"1920x1080\" or \"1920x1080@60\""},
      {"[display]\nconnector = 1\n",
       "station.toml:2: display.connector must be a connector's name in quotes, like \"DP-1\" (prismesh doctor lists them)"},
      {"[display]\nlatency_ms = 1000\n", "station.toml:2: display.latency_ms is 1000; it must be from 0 to 200 ms"},
      {"[eye_tracker]\nlatency_ms = -1\n", "station.toml:2: eye_tracker.latency_ms is -1; it must be from 0 to 500 ms"},
      {"[eye_tracker]\nnoise_mm = nan\n", "station.toml:2: eye_tracker.noise_mm must be a number"},
      {"[eye_tracker]\nnoise_mm = inf\n", "station.toml:2: eye_tracker.noise_mm must be a number"},
      {"[eye_tracker]\nnoise_mm = '1'\n", "station.toml:2: eye_tracker.noise_mm must be a number"},
      {"[eye_tracker]\noffset_mm = [0, 1]\n", "station.toml:2: eye_tracker.offset_mm must be three numbers, like [0, 210, -15]"},
      {"[eye_tracker]\noffset_mm = [0, 1, 'x']\n", "station.toml:2: eye_tracker.offset_mm must be three numbers"},
      {"[eye_tracker]\noffset_mm = [0, 1, 3000]\n", "station.toml:2: eye_tracker.offset_mm holds 3000; it must be from -2000 to 2000 mm"},
      {"[eye_tracker]\neye_separation_mm = 49\n", "station.toml:2: eye_tracker.eye_separation_mm is 49; it must be from 50 to 75 mm"},
      {"[prism_servo]\nid = 253\n", "station.toml:2: prism_servo.id is 253; it must be from 0 to 252"},
      {"[prism_servo]\nbaud = 99999999999999999999\n", "station.toml:2: "},
      {"[prism_servo]\ntravel_mm_per_turn = 0\n", "station.toml:2: prism_servo.travel_mm_per_turn is 0; it must be from 0.1 to 100 mm"},
      {"[display]\nprofile = ''\n", "station.toml:2: display.profile must be a profile's name or file in quotes"},
      {"[hand]\nmouse = 3\n", "station.toml:2: hand.mouse must be a layout's name or file in quotes"},
      {"[document]\nhistory_mb = 1\n", "station.toml:2: document.history_mb is 1; it must be from 16 to 1048576 MB"},
      {"[document]\nhang_s = -1\n", "station.toml:2: document.hang_s is -1; it must be from 0 to 86400 s"},
      {"[haptic_pen]\ndriver = 'falcn'\n",
       "station.toml:2: haptic_pen.driver has no \"falcn\"; the nearest is \"falcon\" of none, simulated, falcon, inverse3"},
      {"[haptic_pen]\nforce_scale = 0.1\n", "station.toml:2: haptic_pen.force_scale is 0.1;"},
      {"[haptic_pen]\nhand = 'both'\n", "station.toml:2: haptic_pen.hand has no \"both\""},
      {"[haptic_pen]\nhand_script = 7\n", "station.toml:2: haptic_pen.hand_script must be a file's name in quotes"},
      {"[haptic_pen]\nport = 'pen'\n", "station.toml:2: haptic_pen.port must be a device's whole path"},
      {"[display]\nprofile = \n", "station.toml:2: "},
      {"[display]\n[display]\n", "station.toml:2: "},
      {"[display]\nprofile = \"\xff\"\n", "station.toml:2: "},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(text).substr(0, std::string_view(message).size()), message) << text;
}

TEST(Settings, keep_the_pens_force_to_what_its_device_holds) {
  EXPECT_EQ(parsed("[haptic_pen]\ndriver = 'falcon'").haptic_pen.max_newton, 8);
  EXPECT_EQ(parsed("[haptic_pen]\ndriver = 'inverse3'").haptic_pen.max_newton, 4);
  EXPECT_EQ(parsed("[haptic_pen]\nmax_newton = 4\ndriver = 'inverse3'").haptic_pen.max_newton, 4);
  EXPECT_EQ(error_of("[haptic_pen]\nmax_newton = 4.5\ndriver = 'inverse3'"),
            "station.toml:2: haptic_pen.max_newton is 4.5; a Haply Inverse3 holds at most 4 N");
}

TEST(Settings, choose_a_screen_and_its_mode) {
  const StationSettings settings = *parse_settings(
      "[display]\nscreen = \"bare\"\nconnector = \"DP-1\"\nmode = \"1920x1200@59.95\"\nconsole_switching = true\n", "station.toml");
  EXPECT_EQ(settings.display.screen, ScreenKind::bare);
  EXPECT_EQ(settings.display.connector, "DP-1");
  EXPECT_EQ(settings.display.mode, (ModeSetting{1920, 1200, 59.95}));
  EXPECT_TRUE(settings.display.console_switching);
  EXPECT_EQ(parse_settings("[display]\nmode = \"\"\n", "station.toml")->display.mode, ModeSetting());
}

TEST(Settings, accepts_the_limits_themselves) {
  parsed("[eye_tracker]\nudp_port = 65535\nlatency_ms = 500\nnoise_mm = 0\neye_separation_mm = 50\noffset_mm = [-2000, 2000, 0]");
  parsed("[prism_servo]\nid = 0\nbaud = 4500000\ntravel_mm_per_turn = 100");
}

TEST(Settings, refuses_numbers_beyond_their_limits) {
  struct Limits {
    const char *section, *key, *below, *low, *high, *above;
  };
  for (const Limits& one :
       std::vector<Limits>{{"display", "latency_ms", "-0.1", "0", "200", "200.1"},
                           {"display", "video_memory_mb", "-1", "0", "1048576", "1048577"},
                           {"document", "history_mb", "15", "16", "1048576", "1048577"},
                           {"document", "hang_s", "-1", "0", "86400", "86401"},
                           {"eye_tracker", "baud", "299", "300", "4000000", "4000001"},
                           {"eye_tracker", "udp_port", "0", "1", "65535", "65536"},
                           {"eye_tracker", "latency_ms", "-0.1", "0", "500", "500.1"},
                           {"eye_tracker", "noise_mm", "-0.1", "0", "50", "50.1"},
                           {"eye_tracker", "offset_mm", "[-2000.1, 0, 0]", "[0, -2000, 0]", "[0, 0, 2000]", "[0, 0, 2000.1]"},
                           {"eye_tracker", "eye_separation_mm", "49.9", "50", "75", "75.1"},
                           {"prism_servo", "baud", "9599", "9600", "4500000", "4500001"},
                           {"prism_servo", "id", "-1", "0", "252", "253"},
                           {"prism_servo", "travel_mm_per_turn", "0.09", "0.1", "100", "100.1"},
                           {"prism_servo", "zero_ticks", "-1048576", "-1048575", "1048575", "1048576"},
                           {"prism_servo", "travel_mm", "0.009", "0.01", "100", "100.1"},
                           {"prism_servo", "speed_mm_s", "0.009", "0.01", "1000", "1000.1"},
                           {"prism_servo", "lag_ms", "-0.1", "0", "200", "200.1"},
                           {"haptic_pen", "max_newton", "0.09", "0.1", "8", "8.1"},
                           {"haptic_pen", "service_port", "0", "1", "65535", "65536"},
                           {"haptic_pen", "stiffness_newton_m", "-1", "0", "5000", "5001"},
                           {"haptic_pen", "friction", "-0.1", "0", "1", "1.1"},
                           {"haptic_pen", "damping_newton_s_m", "-0.1", "0", "5", "5.1"},
                           {"haptic_pen", "workspace_scale", "0", "0.0001", "10000", "10001"},
                           {"remote", "quota_gb", "0", "1", "1000000", "1000001"},
                           {"remote", "file_gb", "0", "1", "1000", "1001"},
                           {"remote", "reserved_gb", "-1", "0", "1000000", "1000001"},
                           {"remote", "upload_hours", "0", "1", "8760", "8761"},
                           {"exhibition", "idle_s", "4", "5", "86400", "86401"},
                           {"exhibition", "warning_s", "0", "1", "600", "601"}}) {
    const std::string key = std::string("[") + one.section + "]\n" + one.key + " = ";
    for (const char* taken : {one.low, one.high}) EXPECT_EQ(error_of(key + taken), "accepted") << key << taken;
    for (const char* refused : {one.below, one.above})
      EXPECT_THAT(error_of(key + refused), HasSubstr("it must be from ")) << key << refused;
  }
}

TEST(Settings, models_come_from_the_network_only_where_an_address_says_so) {
  EXPECT_EQ(parse_settings("", "station.toml")->remote.port, 0);
  const RemoteSettings remote = parse_settings("[remote]\nlisten = '[::]:7443'\nhosts = ['Station.Example']\n", "station.toml")->remote;
  EXPECT_EQ(remote.address, "::");
  EXPECT_EQ(remote.port, 7443);
  EXPECT_EQ(remote.hosts, std::vector<std::string>{"station.example"});
  EXPECT_EQ(error_of("[remote]\nlisten = '0.0.0.0:65535'\n"), "accepted");
  EXPECT_EQ(error_of("[remote]\nlisten = ''\n"), "accepted");
  EXPECT_EQ(error_of("[remote]\nlisten = '0.0.0.0:0'\n"), "accepted");
  for (const char* bad :
       {"'7443'", "':7443'", "'0.0.0.0'", "'0.0.0.0:-1'", "'0.0.0.0:65536'", "'0.0.0.0:x'", "'host:7443'", "'::1:7443'", "'[]:7443'", "5"})
    EXPECT_THAT(error_of(std::string("[remote]\nlisten = ") + bad + "\n"),
                HasSubstr("station.toml:2: remote.listen must be an address and a port"))
        << bad;
  for (const char* bad : {"'a'", "[5]", "['']", "['a b']", "['a/b']"})
    EXPECT_THAT(error_of(std::string("[remote]\nhosts = ") + bad + "\n"), HasSubstr("remote.hosts must be a list of names")) << bad;
}

TEST(Settings, a_real_device_needs_its_own_port) {
  EXPECT_THAT(error_of("[eye_tracker]\nsimulated = false\ndriver = 'dynasight'\n"),
              HasSubstr("station.toml:3: eye_tracker has a driver but no port; say port = "));
  EXPECT_THAT(error_of("[prism_servo]\ndriver = 'dynamixel'\n"), HasSubstr("station.toml:2: prism_servo has a driver but no port"));
  EXPECT_EQ(error_of("[eye_tracker]\ndriver = 'opentrack'\n"), "accepted");
  EXPECT_EQ(error_of("[prism_servo]\ndriver = 'dynamixel'\nsimulated = true\n"), "accepted");
  const std::string both = "[eye_tracker]\ndriver = 'dynasight'\nport = '/dev/a'\n[prism_servo]\ndriver = 'dynamixel'\nport = '/dev/a'\n";
  EXPECT_THAT(error_of(both), HasSubstr("station.toml:6: prism_servo.port is eye_tracker's as well (/dev/a)"));
  EXPECT_EQ(error_of(both + "simulated = true\n"), "accepted");
  const std::string port = "port = '/dev/a'\n", tracker = "[eye_tracker]\n" + port, servo = "[prism_servo]\n" + port;
  EXPECT_EQ(error_of(tracker + servo + "driver = 'dynamixel'\n"), "accepted") << "no tracker's";
  EXPECT_EQ(error_of(tracker + "driver = 'dynasight'\n" + servo), "accepted") << "no servo's";
  EXPECT_EQ(error_of(tracker + "driver = 'opentrack'\n" + servo + "driver = 'dynamixel'\n"), "accepted") << "datagrams need no line";
}

class SettingsFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "prismesh-settings-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path folder_;
};

TEST_F(SettingsFiles, a_later_file_changes_only_the_keys_it_has) {
  const fs::path system = write("system.toml", "[eye_tracker]\nlatency_ms = 1\nnoise_mm = 2\n[prism_servo]\nid = 3\n");
  const fs::path user = write("user.toml", "[eye_tracker]\nnoise_mm = 4\n");
  const fs::path named = write("named.toml", "[prism_servo]\nid = 5\n");
  const Result<StationSettings> settings = read_settings({system, folder_ / "absent.toml", user}, named);
  ASSERT_TRUE(settings) << settings.error().text();
  EXPECT_EQ(settings->eye_tracker.latency_ms, 1);
  EXPECT_EQ(settings->eye_tracker.noise_mm, 4);
  EXPECT_EQ(settings->prism_servo.id, 5);
  EXPECT_EQ(settings->files, (std::vector<fs::path>{system, user, named}));
}

TEST_F(SettingsFiles, a_port_may_come_from_another_file_than_its_driver) {
  const fs::path system = write("system.toml", "[eye_tracker]\ndriver = 'dynasight'\n");
  const fs::path user = write("user.toml", "[eye_tracker]\nport = '/dev/a'\n");
  EXPECT_TRUE(read_settings({system, user}, std::nullopt));
  const Result<StationSettings> alone = read_settings({system}, std::nullopt);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().file, system.string());
  EXPECT_EQ(alone.error().line, 2);
}

TEST_F(SettingsFiles, without_files_every_default_is_kept) {
  const Result<StationSettings> settings = read_settings({folder_ / "a.toml"}, std::nullopt);
  ASSERT_TRUE(settings);
  EXPECT_EQ(all_of(*settings), all_of(StationSettings{}));
  EXPECT_TRUE(settings->files.empty());
}

TEST_F(SettingsFiles, a_named_file_must_exist) {
  const Result<StationSettings> settings = read_settings({}, folder_ / "absent.toml");
  ASSERT_FALSE(settings);
  EXPECT_EQ(settings.error().text(), (folder_ / "absent.toml").string() + ": can't be opened: No such file or directory");
}

TEST_F(SettingsFiles, an_error_names_its_file) {
  const fs::path system = write("system.toml", "[eye_tracker]\n\nnoise = 2\n");
  const Result<StationSettings> settings = read_settings({system}, write("named.toml", ""));
  ASSERT_FALSE(settings);
  EXPECT_EQ(settings.error().file, system.string());
  EXPECT_EQ(settings.error().line, 3);
}

TEST_F(SettingsFiles, a_profile_file_is_relative_to_the_settings) {
  const auto profile = [&](const std::string& value) {
    return read_settings({}, write("etc/station.toml", "[display]\nprofile = '" + value + "'\n"))->display.profile;
  };
  EXPECT_EQ(profile("mono"), "mono");
  EXPECT_EQ(profile("lab.toml"), (folder_ / "etc/lab.toml").string());
  EXPECT_EQ(profile("profiles/lab.toml"), (folder_ / "etc/profiles/lab.toml").string());
  EXPECT_EQ(profile("../lab.toml"), (folder_ / "lab.toml").string());
  EXPECT_EQ(profile("/srv/lab.toml"), "/srv/lab.toml");
}

TEST_F(SettingsFiles, the_environment_sets_the_users_folder) {
  const auto with = [](const char* config, const char* home) {
    const auto set = [](const char* name, const char* value) { value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name); };
    const auto get = [](const char* name) {
      return std::getenv(name) != nullptr ? std::optional<std::string>(std::getenv(name)) : std::nullopt;
    };
    const auto old_config = get("XDG_CONFIG_HOME"), old_home = get("HOME");
    set("XDG_CONFIG_HOME", config);
    set("HOME", home);
    const std::vector<fs::path> files = usual_files();
    set("XDG_CONFIG_HOME", old_config ? old_config->c_str() : nullptr);
    set("HOME", old_home ? old_home->c_str() : nullptr);
    return files;
  };
  using Files = std::vector<fs::path>;
  const fs::path system = "/etc/prismesh/prismesh.toml";
  EXPECT_EQ(with("/c", "/home/u"), (Files{system, "/c/prismesh/prismesh.toml"}));
  EXPECT_EQ(with(nullptr, "/home/u"), (Files{system, "/home/u/.config/prismesh/prismesh.toml"}));
  EXPECT_EQ(with("relative", "/home/u"), (Files{system, "/home/u/.config/prismesh/prismesh.toml"})) << "as the XDG specification has it";
  EXPECT_EQ(with(nullptr, nullptr), Files{system});
}

std::string content(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

const fs::path kExample = test::source_folder() / "systemd" / "prismesh.toml";

TEST(SettingsExample, is_valid_and_keeps_every_default) {
  const Result<StationSettings> settings = read_settings({}, kExample);
  ASSERT_TRUE(settings) << settings.error().text();
  EXPECT_EQ(all_of(*settings), all_of(StationSettings{}));
}

TEST(SettingsExample, its_comments_contain_every_key_with_its_default) {
  // "#key = value" becomes a key; "# A sentence" stays a comment.
  const std::string text = std::regex_replace(content(kExample), std::regex("(^|\n)#(?=[a-z])"), "$1");
  const Result<StationSettings> settings = parse_settings(text, kExample);
  ASSERT_TRUE(settings) << settings.error().text();
  EXPECT_EQ(all_of(*settings), all_of(StationSettings{}));
  const auto keys_of = [](const std::string& toml) {
    std::set<std::string> keys;
    const std::regex line("(^|\n)([a-z_]+) = ");
    std::string section;
    std::istringstream lines(toml);
    for (std::string one; std::getline(lines, one);) {
      if (one.starts_with("[")) section = one;
      std::smatch found;
      if (std::regex_search(one, found, line)) keys.insert(section + found[2].str());
    }
    return keys;
  };
  EXPECT_EQ(keys_of(text), keys_of(kEveryKey));
}

TEST(Settings, a_pin_is_a_hash) {
  for (const char* pin : {"''", "'$6$saltsalt$hash-as-crypt-writes-it'", "'$y$j9T$01234567890123456789'"})
    EXPECT_EQ(error_of(std::string("[exhibition]\npin = ") + pin), "accepted") << pin;
  for (const char* pin : {"4711", "'4711'", "'$6$'", "'plain text that is long enough'"})
    EXPECT_THAT(error_of(std::string("[exhibition]\npin = ") + pin), HasSubstr("not the PIN itself")) << pin;
}

TEST(SettingsExample, the_manual_names_every_key) {
  const std::string manual = content(test::source_folder() / "docs" / "settings.md");
  std::istringstream lines(kEveryKey);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(" = ");
    if (end == std::string::npos) continue;
    EXPECT_THAT(manual, HasSubstr("`" + line.substr(0, end) + "`"));
  }
}

}  // namespace
}  // namespace prismesh::drivers::settings
