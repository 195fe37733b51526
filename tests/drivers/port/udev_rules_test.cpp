#include "tests/drivers/port/udev_rules.h"
#include "tests/support/places.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/space_mouse/report.h"

namespace prismesh::drivers::port {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

UdevRules station_rules() {
  std::ifstream in(test::source_folder() / "systemd" / "udev" / "60-prismesh.rules");
  return read_udev_rules(std::string(std::istreambuf_iterator<char>(in), {}));
}

struct Adapter {
  std::string vendor, product, serial, driver;

  UdevDevice usb() const {
    UdevDevice device{"usb", "usb", {{"idVendor", vendor}, {"idProduct", product}, {"power/control", "auto"}}, {{"DEVTYPE", "usb_device"}}};
    if (!serial.empty()) device.attributes["serial"] = serial;
    return device;
  }
  UdevDevice port() const { return {"usb-serial", driver, {{"latency_timer", "16"}}, {}}; }
  std::vector<UdevDevice> usb_chain() const { return {usb(), {"usb", "usb", {{"idVendor", "1d6b"}, {"idProduct", "0002"}}, {}}}; }
  std::vector<UdevDevice> port_chain() const { return {port(), {"usb", driver, {}, {}}, usb()}; }
  std::vector<UdevDevice> tty_chain() const { return {{"tty", "", {}, {}}, port(), {"usb", driver, {}, {}}, usb()}; }
};

const Adapter kU2d2{"0403", "6014", "FT4THUGO", "ftdi_sio"};
const Adapter kFt232{"0403", "6001", "A50285BI", "ftdi_sio"};
const Adapter kFtX{"0403", "6015", "DK0AB", "ftdi_sio"};
const Adapter kProlific{"067b", "2303", "", "pl2303"};
const Adapter kCp210x{"10c4", "ea60", "0001", "cp210x"};
const Adapter kFalcon{"0403", "cb48", "F1", ""};
const Adapter kPrinter{"04b8", "0202", "P1", "usblp"};

TEST(UdevRules, have_no_problems) { EXPECT_THAT(station_rules().problems, IsEmpty()); }

TEST(UdevRules, every_serial_adapter_is_for_the_group_and_the_local_user) {
  for (const Adapter& adapter : {kU2d2, kFt232, kFtX, kProlific, kCp210x}) {
    const UdevResult result = apply_udev_rules(station_rules().rules, "add", adapter.tty_chain());
    EXPECT_EQ(result.group, "prismesh") << adapter.product;
    EXPECT_EQ(result.mode, "0660");
    EXPECT_THAT(result.tags, ElementsAre("uaccess"));
    EXPECT_THAT(result.properties, ElementsAre(Pair("ID_MM_PORT_IGNORE", "1")));
  }
}

TEST(UdevRules, links_have_the_serial_number_if_there_is_one) {
  const auto links = [](const Adapter& adapter) { return apply_udev_rules(station_rules().rules, "add", adapter.tty_chain()).links; };
  EXPECT_THAT(links(kU2d2), ElementsAre("prismesh/u2d2-FT4THUGO"));
  EXPECT_THAT(links(kFt232), ElementsAre("prismesh/ftdi-A50285BI"));
  EXPECT_THAT(links(kFtX), ElementsAre("prismesh/ftdi-DK0AB"));
  EXPECT_THAT(links(kCp210x), ElementsAre("prismesh/cp210x-0001"));
  EXPECT_THAT(links(kProlific), IsEmpty()) << "most of them have none";
}

TEST(UdevRules, usb_devices_are_not_suspended_or_probed) {
  for (const Adapter& adapter : {kU2d2, kFt232, kFtX, kProlific, kCp210x}) {
    const UdevResult result = apply_udev_rules(station_rules().rules, "add", adapter.usb_chain());
    EXPECT_THAT(result.written, ElementsAre(Pair("power/control", "on"))) << adapter.product;
    EXPECT_EQ(result.properties.at("ID_MM_DEVICE_IGNORE"), "1");
    EXPECT_EQ(result.group, "") << "the line is opened, not the USB device";
  }
}

TEST(UdevRules, ftdi_chips_have_a_latency_of_one_millisecond) {
  for (const Adapter& adapter : {kU2d2, kFt232, kFtX})
    for (const char* action : {"add", "bind"}) {
      const UdevResult result = apply_udev_rules(station_rules().rules, action, adapter.port_chain());
      EXPECT_THAT(result.written, ElementsAre(Pair("latency_timer", "1"))) << adapter.product;
    }
  EXPECT_THAT(apply_udev_rules(station_rules().rules, "add", kCp210x.port_chain()).written, IsEmpty());
}

TEST(UdevRules, the_pen_may_be_opened_over_usb) {
  const UdevResult result = apply_udev_rules(station_rules().rules, "add", kFalcon.usb_chain());
  EXPECT_EQ(result.group, "prismesh");
  EXPECT_EQ(result.mode, "0660");
  EXPECT_THAT(result.tags, ElementsAre("uaccess"));
  EXPECT_THAT(result.written, ElementsAre(Pair("power/control", "on")));
}

TEST(UdevRules, every_space_mouse_may_be_read_and_no_other_hid_device) {
  const UdevRules rules = station_rules();
  const auto applied = [&](unsigned vendor, unsigned product) {
    char hex[2][5];
    std::snprintf(hex[0], sizeof hex[0], "%04x", vendor & 0xFFFF);
    std::snprintf(hex[1], sizeof hex[1], "%04x", product & 0xFFFF);
    const Adapter adapter{hex[0], hex[1], "", ""};
    return apply_udev_rules(rules.rules, "add", {{"hidraw", "", {}, {}}, {"usb", "usbhid", {}, {}}, adapter.usb()});
  };
  int known = 0;
  for (const unsigned vendor : {0x046Du, 0x256Fu})
    for (unsigned product = 0xC5F0; product <= 0xC6FF; ++product) {
      const bool is_one =
          space_mouse::find_space_mouse(static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)).has_value();
      known += is_one ? 1 : 0;
      const UdevResult result = applied(vendor, product);
      ASSERT_EQ(result.mode, is_one ? "0660" : "") << std::hex << vendor << ":" << product;
      ASSERT_EQ(result.group, is_one ? "prismesh" : "");
      ASSERT_EQ(result.tags.size(), is_one ? 1u : 0u);
    }
  EXPECT_GT(known, 15);
}

TEST(UdevRules, no_other_device_is_changed) {
  const std::vector<UdevDevice> on_board{{"tty", "", {}, {}}, {"pnp", "serial", {}, {}}};
  for (const std::vector<UdevDevice>& chain : {kPrinter.usb_chain(), kPrinter.tty_chain(), on_board}) {
    const UdevResult result = apply_udev_rules(station_rules().rules, "add", chain);
    EXPECT_EQ(result.group + result.mode, "");
    EXPECT_THAT(result.written, IsEmpty());
    EXPECT_THAT(result.links, IsEmpty());
  }
  const UdevResult removed = apply_udev_rules(station_rules().rules, "remove", kU2d2.usb_chain());
  EXPECT_THAT(removed.written, IsEmpty());
}

TEST(UdevRulesReader, finds_what_udev_refuses) {
  const auto problem = [](const std::string& text) {
    const UdevRules read = read_udev_rules(text);
    return read.problems.empty() ? "none" : read.problems.front();
  };
  EXPECT_EQ(problem("SUBSYSTEM==\"tty\", MODE=\"0660\""), "none");
  EXPECT_THAT(problem("\n\nSUBSYSTEM=\"tty\", MODE=\"0660\""), HasSubstr("3: SUBSYSTEM has no operator ="));
  EXPECT_THAT(problem("SUBSYSTEM==tty, MODE=\"0660\""), HasSubstr("can't be read"));
  EXPECT_THAT(problem("SUBSYSTEM==\"tty\" MODE=\"0660\""), HasSubstr("can't be read"));
  EXPECT_THAT(problem("SUBSYSTEM==\"tty\", MODE=\"0660\","), HasSubstr("can't be read"));
  EXPECT_THAT(problem("SUBSYSTEM==\"tty, MODE=\"0660\""), HasSubstr("can't be read"));
  EXPECT_THAT(problem("SUBSYTEM==\"tty\", MODE=\"0660\""), HasSubstr("unknown key SUBSYTEM"));
  EXPECT_THAT(problem("ATTR==\"tty\", MODE=\"0660\""), HasSubstr("ATTR needs {..}"));
  EXPECT_THAT(problem("MODE{x}=\"0660\""), HasSubstr("MODE has no {..}"));
  EXPECT_THAT(problem("MODE=\"rw\""), HasSubstr("rw is no mode"));
  EXPECT_THAT(problem("ATTRS{a}=\"1\""), HasSubstr("ATTRS has no operator ="));
  EXPECT_THAT(problem("SYMLINK+=\"a-$atr{serial}\""), HasSubstr("unknown substitution"));
  EXPECT_THAT(problem("SUBSYSTEM==\"tty\""), HasSubstr("does nothing"));
  EXPECT_THAT(problem("GOTO=\"end\""), HasSubstr("no label end below"));
  EXPECT_THAT(problem("LABEL=\"a\"\nGOTO=\"a\""), HasSubstr("2: no label a below"));
  EXPECT_THAT(problem("LABEL=\"a\"\nLABEL=\"a\""), HasSubstr("2: a second label a"));
}

}  // namespace
}  // namespace prismesh::drivers::port
