#include "drivers/port/hid_port.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::drivers::port {
namespace {

namespace fs = std::filesystem;

class HidDevices : public ::testing::Test {
 protected:
  HidDevices() {
    std::string name = (fs::temp_directory_path() / "prismesh-hid-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~HidDevices() override { fs::remove_all(folder_); }
  void add(const std::string& name, const std::string& uevent) const {
    fs::create_directories(folder_ / name / "device");
    std::ofstream(folder_ / name / "device" / "uevent") << uevent;
  }
  fs::path folder_;
};

TEST_F(HidDevices, are_listed_with_their_numbers) {
  add("hidraw1", "DRIVER=hid-generic\nHID_ID=0003:0000256F:0000C635\nHID_NAME=3Dconnexion SpaceMouse Compact\nHID_PHYS=usb\n");
  add("hidraw0", "HID_ID=0003:0000046D:0000C626\nHID_NAME=3Dconnexion SpaceNavigator\n");
  add("hidraw2", "HID_NAME=without numbers\n");
  add("hidraw3", "HID_ID=0003:0000046D\n");
  add("hidraw4", "HID_ID=0003:1234046D:0000C626\n");
  fs::create_directories(folder_ / "hidraw5");
  const std::vector<HidDevice> found = list_hid_devices(folder_.string());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].path, "/dev/hidraw0");
  EXPECT_EQ(found[0].vendor, 0x046D);
  EXPECT_EQ(found[0].product, 0xC626);
  EXPECT_EQ(found[1].name, "3Dconnexion SpaceMouse Compact");
  EXPECT_TRUE(list_hid_devices((folder_ / "nowhere").string()).empty());
}

TEST(HidPorts, give_one_report_a_read_until_the_device_is_gone) {
  // A socket of packets keeps their borders, as hidraw does.
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends.data()), 0);
  const auto port = hid_port_of(ends[0]);
  std::array<std::byte, 64> report{};
  EXPECT_EQ(port->read(report).bytes, 0u);
  ASSERT_EQ(::write(ends[1], "\1abcdef", 7), 7);
  ASSERT_EQ(::write(ends[1], "\3z", 2), 2);
  EXPECT_EQ(port->read(report).bytes, 7u);
  EXPECT_EQ(port->read(report).bytes, 2u);
  EXPECT_EQ(report[1], std::byte{'z'});
  EXPECT_EQ(port->read(report).status, PortStatus::ok);
  ::close(ends[1]);
  EXPECT_EQ(port->read(report).status, PortStatus::gone);
  EXPECT_EQ(port->read(report).status, PortStatus::gone);
}

TEST(HidPorts, that_are_missing_are_named) {
  const auto port = open_hid_port("/dev/hidraw-nowhere", "SpaceMouse");
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().text(), testing::StartsWith("SpaceMouse (/dev/hidraw-nowhere): "));
}

}  // namespace
}  // namespace prismesh::drivers::port
