#include "ipc/setup/checks.h"

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/display/profile.h"
#include "ipc/setup/messages_json.h"

namespace prismesh::ipc {
namespace {

using testing::HasSubstr;

/// The field that is wrong and why; empty: nothing is.
std::string fault(const Result<void>& result) { return result ? "" : result.error().file + ": " + result.error().message; }

TEST(SetupName, is_a_label_of_rfc_1123) {
  for (const char* good : {"a", "station", "Prismesh-12ab", "3d-lab", "x1", "a--b"}) EXPECT_EQ(fault(check_name(good)), "") << good;
  EXPECT_TRUE(check_name(std::string(63, 'a')));
  for (const std::string& bad :
       {std::string(), std::string("-a"), std::string("a-"), std::string("-"), std::string("a b"), std::string("a.b"), std::string("a_b"),
        std::string("a\nb"), std::string("../a"), std::string("ä"), std::string("a\0b", 3), std::string("12"), std::string("localhost"),
        std::string("LocalHost"), std::string(64, 'a'), std::string("a;reboot"), std::string("a/")})
    EXPECT_THAT(fault(check_name(bad)), HasSubstr("name: ")) << bad;
}

struct NetworkCase {
  const char* address;
  const char* gateway;
  std::vector<std::string> dns;
  const char* field;  ///< that is wrong; empty: none
};

TEST(SetupNetwork, is_one_that_a_machine_can_have) {
  const NetworkCase cases[] = {
      {"192.168.1.20/24", "192.168.1.1", {"192.168.1.1", "9.9.9.9"}, ""},
      {"192.168.1.20/24", "", {}, ""},
      {"10.0.0.1/31", "10.0.0.0", {}, ""},
      {"10.0.0.1/32", "", {}, ""},
      {"fd00::20/64", "fd00::1", {"fd00::1"}, ""},
      {"fd00::20/64", "fe80::1", {}, ""},
      {"192.168.1.20/23", "192.168.0.1", {}, ""},
      // The address.
      {"192.168.1.20", "", {}, "address"},
      {"", "", {}, "address"},
      {"192.168.1/24", "", {}, "address"},
      {"192.168.1.020/24", "", {}, "address"},
      {"192.168.1.256/24", "", {}, "address"},
      {"192.168.1.20/0", "", {}, "address"},
      {"192.168.1.20/33", "", {}, "address"},
      {"192.168.1.20/-1", "", {}, "address"},
      {"192.168.1.20/2 4", "", {}, "address"},
      {"192.168.1.20/0024", "", {}, "address"},
      {"192.168.1.20/24\nDHCP=yes", "", {}, "address"},
      {" 192.168.1.20/24", "", {}, "address"},
      {"192.168.1.0/24", "", {}, "address"},
      {"192.168.1.255/24", "", {}, "address"},
      {"127.0.0.1/8", "", {}, "address"},
      {"0.0.0.1/8", "", {}, "address"},
      {"224.0.0.5/24", "", {}, "address"},
      {"fd00::20/129", "", {}, "address"},
      {"ff02::1/64", "", {}, "address"},
      {"::1/64", "", {}, "address"},
      {"::/64", "", {}, "address"},
      {"fe80::1%eth0/64", "", {}, "address"},
      // The gateway.
      {"192.168.1.20/24", "192.168.2.1", {}, "gateway"},
      {"192.168.1.20/25", "192.168.1.129", {}, "gateway"},
      {"192.168.1.20/24", "192.168.1.20", {}, "gateway"},
      {"192.168.1.20/24", "192.168.1.0", {}, "gateway"},
      {"192.168.1.20/24", "192.168.1.255", {}, "gateway"},
      {"192.168.1.20/24", "fd00::1", {}, "gateway"},
      {"192.168.1.20/24", "router", {}, "gateway"},
      {"192.168.1.20/24", "192.168.1.1\n[Route]", {}, "gateway"},
      {"fd00::20/64", "fd01::1", {}, "gateway"},
      // The name servers.
      {"192.168.1.20/24", "", {"dns.example"}, "dns"},
      {"192.168.1.20/24", "", {""}, "dns"},
      {"192.168.1.20/24", "", {"9.9.9.9\noptions rotate"}, "dns"},
      {"192.168.1.20/24", "", {"1.1.1.1", "1.0.0.1", "9.9.9.9", "8.8.8.8"}, "dns"},
  };
  for (const NetworkCase& each : cases) {
    const std::string said = fault(check_network({false, each.address, each.gateway, each.dns}));
    EXPECT_EQ(said.substr(0, said.find(':')), each.field) << each.address << " " << each.gateway << ": " << said;
  }
  const std::string zero("192.168.1.20\0/24", 16);
  EXPECT_FALSE(check_network({false, zero, "", {}}));
}

TEST(SetupNetwork, with_dhcp_sets_nothing_else) {
  EXPECT_TRUE(check_network({true, "", "", {}}));
  EXPECT_FALSE(check_network({true, "192.168.1.20/24", "", {}}));
  EXPECT_FALSE(check_network({true, "", "192.168.1.1", {}}));
  EXPECT_FALSE(check_network({true, "", "", {"9.9.9.9"}}));
}

TEST(SetupProfile, is_a_built_in_one_and_no_path) {
  EXPECT_TRUE(check_profile("prism-mask"));
  EXPECT_TRUE(check_profile("mono"));
  for (const char* bad : {"", "prism", "../prism-mask", "/etc/shadow", "prism-mask.toml", "mono\n"})
    EXPECT_FALSE(check_profile(bad)) << bad;
}

TEST(SetupCalibration, is_a_whole_profile_with_a_name_that_a_file_can_have) {
  drivers::display::Profile profile = drivers::display::built_in_profiles().front();
  profile.monitor = {"EIZ \"CG2420\"", "\n12", {1920, 1200}};
  for (const char* good : {"EIZ-CG2420-12345", "a", "prism-mask-calibrated"}) {
    profile.name = good;
    EXPECT_EQ(fault(check_calibration(drivers::display::profile_text(profile))), "");
    EXPECT_LT(encode_setup_request(SetCalibration{drivers::display::profile_text(profile)}).value().size(), kMaxSetupRequestBytes / 2);
  }
  for (const char* bad : {"../../x", "a/b", "a b", ".", "prism-mask", "mono", "a\nb"}) {
    profile.name = bad;
    EXPECT_THAT(fault(check_calibration(drivers::display::profile_text(profile))), HasSubstr("calibration: ")) << bad;
  }
  for (const char* bad : {"profile = 7", "[optics", "name = 'a'\nweaves = 'mask'", "name = 'a'\nweave = 'knit'"})
    EXPECT_FALSE(check_calibration(bad)) << bad;
}

TEST(SetupZone, is_written_as_one_and_leads_nowhere_else) {
  for (const char* good : {"UTC", "Europe/Berlin", "America/Argentina/Buenos_Aires", "America/Port-au-Prince", "Etc/GMT+5"})
    EXPECT_TRUE(check_zone(good)) << good;
  for (const char* bad : {"", "/etc/passwd", "../UTC", "Europe/../UTC", "Europe//Berlin", "Europe/", "Europe/Berlin\n", "Europe Berlin",
                          ".", "-a", "Europe/1"})
    EXPECT_EQ(fault(check_zone(bad)).substr(0, 5), "zone:") << bad;
  EXPECT_FALSE(check_zone(std::string(61, 'a')));
}

TEST(SetupClock, is_a_day_and_time_that_there_are) {
  EXPECT_TRUE(check_clock({"2026-11-28", "16:05"}));
  EXPECT_TRUE(check_clock({"2028-02-29", "00:00"}));
  for (const char* bad : {"", "2026-11-31", "2027-02-29", "2026-13-01", "2026-00-01", "2026-01-00", "2019-12-31", "2100-01-01", "26-11-28",
                          "2026/11/28", "2026-11-28 ", "2026-1-1"})
    EXPECT_EQ(fault(check_clock({bad, "16:05"})).substr(0, 5), "date:") << bad;
  for (const char* bad : {"", "24:00", "12:60", "1:05", "16:05:00", "16.05", "-1:00"})
    EXPECT_EQ(fault(check_clock({"2026-11-28", bad})).substr(0, 5), "time:") << bad;
}

TEST(SetupMessages, come_back_as_they_were) {
  const SetNetwork network{false, "192.168.1.20/24", "192.168.1.1", {"9.9.9.9"}};
  const auto asked = decode_setup_request(encode_setup_request(network).value());
  ASSERT_TRUE(asked) << asked.error().text();
  EXPECT_EQ(std::get<SetNetwork>(*asked).gateway, "192.168.1.1");
  EXPECT_EQ(std::get<SetNetwork>(*asked).dns, network.dns);
  StationSetup station;
  station.due = true;
  station.network = network;
  station.zones = {"Europe/Berlin", "UTC"};
  const auto said = decode_setup_answer(encode_setup_answer(station));
  ASSERT_TRUE(said) << said.error().text();
  EXPECT_TRUE(std::get<StationSetup>(*said).due);
  EXPECT_EQ(std::get<StationSetup>(*said).network.address, "192.168.1.20/24");
  EXPECT_EQ(std::get<StationSetup>(*said).zones, station.zones);
}

TEST(SetupMessages, are_refused_where_a_field_is_missing_unknown_or_wrong) {
  for (const char* bad :
       {R"({"request":"set_name"})", R"({"request":"set_name","name":"a","more":1})", R"({"request":"set_name","name":7})",
        R"({"request":"set_root","name":"a"})", R"({"name":"a"})", "", "[]", R"({"request":"set_name","name":"a\nb"})",
        R"({"request":"keep_page","page":"../x"})", R"({"request":"set_network"})"})
    EXPECT_FALSE(decode_setup_request(bad)) << bad;
  EXPECT_FALSE(decode_setup_request(std::string(100000, '[')));
}

}  // namespace
}  // namespace prismesh::ipc
