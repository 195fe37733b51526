// The set-up of a station as whole processes: the kiosk's pages by keyboard, mouse and fingers, the program that writes, and what is on the
// disk afterwards.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/station/station.h"

namespace prismesh::test {
namespace {

using testing::HasSubstr;

class SetUpTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string missing = missing_programs();
    if (!program_exists("systemd-socket-activate")) missing += " systemd";
    if (!missing.empty()) GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
    root_ = station_->folder() / "root";
    write("etc/hostname", "prismesh-12ab\n");
    write("etc/prismesh/prismesh.toml", "[display]\nprofile = \"mono\"\n");
    write("etc/prismesh/set-up-due", "");
    write("usr/share/zoneinfo/zone1970.tab", "DE\t+0\tEurope/Berlin\nFR\t+0\tEurope/Paris\nJP\t+0\tAsia/Tokyo\n");
    for (const char* zone : {"UTC", "Europe/Berlin", "Europe/Paris", "Asia/Tokyo"})
      write(std::string("usr/share/zoneinfo/") + zone, "zone");
    std::filesystem::create_directories(root_ / "etc/systemd/network");
    station_->start_setup_service(root_);
  }
  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::string text(const std::string& path) const {
    std::stringstream text;
    text << std::ifstream(root_ / path).rdbuf();
    return text.str();
  }
  /// Waits until the page is shown and kept.
  bool on_page(const std::string& name) { return !station_->kiosk().wait_for("setup " + name).empty() && on_page_again(name); }
  /// The same for a page whose line has been read.
  bool on_page_again(const std::string& name) {
    for (int tries = 0; tries < 1000 && text("etc/prismesh/set-up-due") != name + "\n"; ++tries) rest(10);
    return text("etc/prismesh/set-up-due") == name + "\n";
  }
  static void rest(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }
  /// The last that the kiosk said of an item is this.
  bool item_is(const std::string& name, const std::string& state) {
    for (int tries = 0; tries < 1000; ++tries, rest(10))
      if (const auto item = station_->item(name); item && item->state == state) return true;
    return false;
  }
  void key(const char* name, int times = 1) {
    for (int i = 0; i < times; ++i) station_->key(name);
  }
  void clear_field(int letters) { key("BackSpace", letters); }
  void tap(const std::string& name) { station_->click_item("setup " + name); }

  std::unique_ptr<Station> station_;
  std::filesystem::path root_;
};

TEST_F(SetUpTest, leads_by_keyboard_through_all_pages) {
  station_->start_setup();
  ASSERT_TRUE(item_is("setup field name", "prismesh-12ab"));
  station_->show_people("setup_name");
  clear_field(13);
  station_->type("crash lab");
  key("Return");
  ASSERT_TRUE(item_is("setup trouble name", "a name has letters from a to z, digits and hyphens only"));
  clear_field(9);
  station_->type("crash-lab");
  key("Return");
  ASSERT_TRUE(on_page("network"));
  EXPECT_EQ(text("etc/hostname"), "crash-lab\n");

  key("Right");
  station_->type("192.168.1.20/24");
  key("Tab");
  station_->type("192.168.2.1");
  key("Return");
  ASSERT_TRUE(item_is("setup trouble gateway", "it doesn't lie in the network of the address: compare both, and the prefix behind the /"));
  rest(300);
  station_->show_people("setup_network");
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/systemd/network/70-prismesh-setup.network")) << "nothing of it is set";
  clear_field(3);
  station_->type("1.1");
  key("Return");
  for (int tries = 0; tries < 1000 && !std::filesystem::exists(root_ / "etc/systemd/network/70-prismesh-setup.network"); ++tries) rest(10);
  EXPECT_THAT(text("etc/systemd/network/70-prismesh-setup.network"), HasSubstr("Address=192.168.1.20/24\nGateway=192.168.1.1\n"));
  rest(500);
  key("Return");  // the page stays until the address is seen
  ASSERT_TRUE(on_page("profile"));

  station_->show_people("setup_profile");
  key("Next");  // Page Down: skipped
  ASSERT_TRUE(on_page("zone"));
  key("Prior");  // Page Up: back
  ASSERT_TRUE(on_page("profile"));
  key("Return");  // nothing was chosen
  ASSERT_TRUE(on_page("zone"));
  EXPECT_EQ(text("etc/prismesh/prismesh.toml"), "[display]\nprofile = \"mono\"\n");

  station_->type("euro");
  key("Right");
  ASSERT_TRUE(item_is("setup choice Europe/Paris", "on"));
  rest(300);
  station_->show_people("setup_zone");
  key("Return");
  ASSERT_TRUE(on_page("clock"));
  EXPECT_EQ(std::filesystem::read_symlink(root_ / "etc/localtime"), "../usr/share/zoneinfo/Europe/Paris");
  station_->show_people("setup_clock");
  clear_field(10);
  station_->type("2026-02-30");
  key("Return");
  ASSERT_TRUE(item_is("setup trouble date", "that month has no such day"));
  key("Next");
  ASSERT_TRUE(on_page("pairing"));
  key("Return");  // off, as it is
  ASSERT_TRUE(on_page("done"));
  station_->show_people("setup_done");
  station_->kiosk().skip_lines();
  key("Return");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty()) << "the kiosk itself";
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/prismesh/set-up-due"));
}

TEST_F(SetUpTest, leads_by_fingers_and_each_target_is_as_large_as_one) {
  station_->start_setup();
  ASSERT_TRUE(on_page_again("name"));
  const auto as_large_as_a_finger = [&](const std::vector<std::string>& names) {
    const double pixel_mm = 0.27;  // of the profile mono
    for (const std::string& name : names) {
      const auto item = station_->item("setup " + name);
      ASSERT_TRUE(item.has_value()) << name;
      EXPECT_GE(item->height * pixel_mm, 15) << name;
      EXPECT_GE(item->width * pixel_mm, 15) << name;
      EXPECT_GE(item->y, 0) << name;
      EXPECT_LE(item->y + item->height, 800) << name << " is on the picture";
      EXPECT_LE(item->x + item->width, 1280) << name;
    }
  };
  as_large_as_a_finger({"key a", "key 0", "key -", "erase", "field name", "next", "skip", "leave"});
  for (int i = 0; i < 13; ++i) tap("erase");
  for (const char* letter : {"l", "a", "b", "-", "7"}) tap(std::string("key ") + letter);
  ASSERT_TRUE(item_is("setup field name", "lab-7"));
  tap("next");
  ASSERT_TRUE(on_page("network"));
  EXPECT_EQ(text("etc/hostname"), "lab-7\n");

  tap("choice Fixed address");
  ASSERT_TRUE(item_is("setup choice Fixed address", "on"));
  ASSERT_TRUE(item_is("setup field address", ""));
  as_large_as_a_finger({"choice By itself (DHCP)", "key 1", "key f", "key /", "key blank", "field dns", "back"});
  tap("field dns");
  for (const char* letter : {"9", ".", "9", ".", "9", ".", "9"}) tap(std::string("key ") + letter);
  tap("field address");
  for (const char letter : std::string("10.0.0.2/24")) tap(std::string("key ") + letter);
  ASSERT_TRUE(item_is("setup field address", "10.0.0.2/24"));
  ASSERT_TRUE(item_is("setup field dns", "9.9.9.9"));
  tap("next");
  for (int tries = 0; tries < 1000 && !std::filesystem::exists(root_ / "etc/systemd/network/70-prismesh-setup.network"); ++tries) rest(10);
  EXPECT_THAT(text("etc/systemd/network/70-prismesh-setup.network"), HasSubstr("Address=10.0.0.2/24\nDNS=9.9.9.9\n"));
  rest(300);
  tap("choice By itself (DHCP)");  // one can go back from it
  tap("next");
  for (int tries = 0; tries < 1000 && std::filesystem::exists(root_ / "etc/systemd/network/70-prismesh-setup.network"); ++tries) rest(10);
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/systemd/network/70-prismesh-setup.network"));
  rest(300);
  tap("next");
  ASSERT_TRUE(on_page("profile"));

  as_large_as_a_finger({"choice anaglyph", "choice mono-right"});
  tap("choice anaglyph");
  tap("next");
  ASSERT_TRUE(on_page("calibration"));
  EXPECT_THAT(text("etc/prismesh/prismesh.toml"), HasSubstr("profile = \"anaglyph\""));
  rest(300);
  station_->show_people("setup_calibration");
  tap("calibrate");
  ASSERT_FALSE(station_->kiosk().wait_for("calibration 1 ").empty());
  for (int presses = 0; presses < 20 && station_->kiosk().last("calibration saved").empty(); ++presses, rest(400)) key("Return");
  const std::filesystem::path calibrated = root_ / "etc/prismesh/displays/anaglyph-calibrated.toml";
  for (int tries = 0; tries < 1000 && text("etc/prismesh/prismesh.toml").find("calibrated") == std::string::npos; ++tries) rest(10);
  EXPECT_THAT(text("etc/prismesh/prismesh.toml"), HasSubstr("profile = \"displays/anaglyph-calibrated.toml\""))
      << "for the device daemon too";
  EXPECT_TRUE(std::filesystem::exists(calibrated));
  rest(500);
  tap("back");
  ASSERT_TRUE(on_page("profile"));
  tap("choice mono");
  tap("next");
  ASSERT_TRUE(on_page("zone"));
  as_large_as_a_finger({"choice UTC", "key q", "key /", "next"});
  const auto key_before = station_->item("setup key o");
  for (const char* letter : {"t", "o", "k"}) tap(std::string("key ") + letter);
  ASSERT_TRUE(item_is("setup choice Asia/Tokyo", "on"));
  EXPECT_EQ(station_->item("setup key o")->y, key_before->y) << "fewer choices don't move the keys under the finger";
  tap("next");
  ASSERT_TRUE(on_page("clock"));
  EXPECT_EQ(std::filesystem::read_symlink(root_ / "etc/localtime"), "../usr/share/zoneinfo/Asia/Tokyo");
  as_large_as_a_finger({"key 5", "key :", "field time"});
  tap("skip");
  ASSERT_TRUE(on_page("pairing"));
  tap("choice On");
  tap("next");
  ASSERT_TRUE(item_is("setup next", "Next"));
  for (int tries = 0; tries < 1000 && text("etc/prismesh/prismesh.toml").find("0.0.0.0:7443") == std::string::npos; ++tries) rest(10);
  EXPECT_THAT(text("etc/prismesh/prismesh.toml"), HasSubstr("listen = \"0.0.0.0:7443\""));
  rest(300);
  tap("next");  // without a code: the service doesn't run here
  ASSERT_TRUE(on_page("done"));
  station_->kiosk().skip_lines();
  tap("next");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty()) << "the kiosk itself";
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/prismesh/set-up-due"));
}

TEST_F(SetUpTest, goes_on_where_it_was_when_the_kiosk_is_killed_and_leaves_until_the_next_start) {
  station_->start_setup();
  ASSERT_TRUE(on_page_again("name"));
  key("Next", 2);
  ASSERT_TRUE(on_page("profile"));
  station_->kiosk().kill(SIGKILL);
  station_->kiosk().wait_for_exit();
  station_->start_setup();
  EXPECT_EQ(station_->kiosk().last("setup "), "setup profile");
  station_->kiosk().skip_lines();
  key("Escape");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty()) << "the kiosk itself";
  EXPECT_EQ(text("etc/prismesh/set-up-due"), "profile\n");
  EXPECT_EQ(text("etc/hostname"), "prismesh-12ab\n");
  station_->start_setup();
  EXPECT_EQ(station_->kiosk().last("setup "), "setup profile");
}

TEST_F(SetUpTest, is_called_again_later_and_leads_back_to_the_document) {
  std::filesystem::remove(root_ / "etc/prismesh/set-up-due");
  station_->start_kiosk();
  Process& kiosk = station_->kiosk();
  EXPECT_EQ(kiosk.last("setup "), "") << "it isn't due";
  kiosk.skip_lines();
  key("F12");
  ASSERT_FALSE(kiosk.wait_for("setup name").empty());
  key("Next");
  ASSERT_FALSE(kiosk.wait_for("setup network").empty());
  kiosk.skip_lines();
  key("Escape");
  ASSERT_FALSE(kiosk.wait_until([](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); }).empty())
      << "the document is shown as before";
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/prismesh/set-up-due")) << "and it doesn't come by itself";
}

TEST_F(SetUpTest, visitors_of_an_exhibition_do_not_come_to_it) {
  const std::filesystem::path settings = station_->folder() / "exhibition.toml";
  std::ofstream(settings) << "[display]\nprofile = \"mono\"\n[exhibition]\ndeck = \"" << station_->deck().string() << "\"\npin = \""
                          << kHashOf4711 << "\"\n";
  station_->start_exhibition(settings);  // although the set-up is due
  Process& kiosk = station_->kiosk();
  EXPECT_EQ(kiosk.last("setup "), "");
  station_->move(300, 300);
  station_->click(340, 320);
  ASSERT_FALSE(kiosk.wait_for("exhibition visit").empty());
  ASSERT_FALSE(kiosk.wait_for("exhibition deck").empty());
  rest(500);
  key("F12");
  ASSERT_FALSE(kiosk.wait_for("item \"pin back\"").empty()) << "the PIN is asked for";
  EXPECT_EQ(kiosk.last("setup "), "");
  rest(500);
  station_->type("4711");
  key("Return");
  ASSERT_FALSE(kiosk.wait_for("exhibition unlocked").empty());
  rest(500);
  key("F12");
  ASSERT_FALSE(kiosk.wait_for("setup name").empty());
  key("Escape");
  ASSERT_FALSE(kiosk.wait_for("exhibition show").empty()) << "and it is locked again";
}

}  // namespace
}  // namespace prismesh::test
