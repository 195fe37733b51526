// A SpaceMouse on a hidraw device that umockdev adds to /sys and /dev: what finds, opens and reads it is what the kiosk has. umockdev has
// no simulation of its own for hidraw; this test handles each read, so that a report stays one report.
#include <stdlib.h>
#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/space_mouse/space_mice.h"

namespace prismesh::drivers::space_mouse {
namespace {

constexpr const char* kHid = "/devices/usb1/1-9/1-9:1.0/0003:046D:C626.0001";
using Report = std::vector<unsigned char>;

class FakeHidraw {
 public:
  FakeHidraw() { g_signal_connect(handler_, "handle-read", G_CALLBACK(read), this); }
  ~FakeHidraw() {
    g_object_unref(bed_);
    g_object_unref(handler_);
  }
  FakeHidraw(const FakeHidraw&) = delete;
  FakeHidraw& operator=(const FakeHidraw&) = delete;

  /// Each time under another number: umockdev keeps the file in /dev.
  void plug() {
    node_ = "hidraw" + std::to_string(next_++);
    GError* error = nullptr;
    ASSERT_NE(umockdev_testbed_attach_ioctl(bed_, ("/dev/" + node_).c_str(), handler_, &error), 0) << error->message;
    const std::string text = std::string("P: ") + kHid +
                             "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000046D:0000C626\nE: HID_NAME=3Dconnexion SpaceNavigator\n\nP: " + kHid +
                             "/hidraw/" + node_ + "\nN: " + node_ + "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/" + node_ +
                             "\nL: device=../../../0003:046D:C626.0001\n";
    ASSERT_NE(umockdev_testbed_add_from_string(bed_, text.c_str(), &error), 0) << error->message;
    const std::lock_guard lock(mutex_);
    plugged_ = true;
  }
  void unplug() {
    {
      const std::lock_guard lock(mutex_);
      plugged_ = false;
      reports_.clear();
    }
    umockdev_testbed_remove_device(bed_, (std::string("/sys") + kHid + "/hidraw/" + node_).c_str());
    umockdev_testbed_remove_device(bed_, (std::string("/sys") + kHid).c_str());
  }
  void send(std::initializer_list<Report> reports) {
    const std::lock_guard lock(mutex_);
    reports_.insert(reports_.end(), reports);
  }

 private:
  /// By umockdev's thread. As the kernel does: one report a read, EIO once the device is gone.
  static gboolean read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    FakeHidraw& device = *static_cast<FakeHidraw*>(self);
    const std::lock_guard lock(device.mutex_);
    UMockdevIoctlData* to = umockdev_ioctl_client_get_arg(client);
    if (!device.plugged_ || device.reports_.empty()) {
      umockdev_ioctl_client_complete(client, -1, device.plugged_ ? EAGAIN : EIO);
      return TRUE;
    }
    const Report report = device.reports_.front();
    device.reports_.pop_front();
    const std::size_t count = std::min(report.size(), static_cast<std::size_t>(to->data_len));
    std::memcpy(to->data, report.data(), count);
    umockdev_ioctl_client_complete(client, static_cast<glong>(count), 0);
    return TRUE;
  }

  UMockdevTestbed* bed_ = umockdev_testbed_new();
  UMockdevIoctlBase* handler_ = umockdev_ioctl_base_new();
  std::mutex mutex_;
  bool plugged_ = false;
  int next_ = 0;
  std::string node_;
  std::deque<Report> reports_;
};

TEST(SpaceMouseOnHidraw, is_found_opened_and_read_and_comes_back_after_it_was_unplugged) {
  ::setenv("SPNAV_SOCKET", "/nonexistent/spnav.sock", 1);
  FakeHidraw device;
  ASSERT_NE(umockdev_in_mock_environment(), 0)
      << "run me under umockdev-wrapper";  // keeps its first answer, and is right with a device only
  ManualClock clock;
  SpaceMice mice(clock, system_sources(), {.dead_zone = 0, .exponent = 1});
  const auto later = [&](std::int64_t ms) {
    clock.advance_ns(ms * 1'000'000);
    mice.turn();
  };
  later(0);
  EXPECT_FALSE(mice.any());
  device.plug();
  device.send({{1, 0x5E, 1, 0, 0, 0, 0}});  // before it is opened: of the past
  later(1000);
  EXPECT_EQ(mice.names(), "SpaceNavigator");
  EXPECT_TRUE(mice.motion().at_rest());

  device.send({{1, 0x5E, 1, 0x51, 0xFF, 0, 0}, {2, 0, 0, 0, 0, 0xA2, 0xFE}, {3, 2, 0}});
  later(10);
  EXPECT_EQ(mice.motion().shift, (std::array<double, 3>{1, -0.5, 0}));
  EXPECT_EQ(mice.motion().turn, (std::array<double, 3>{0, 0, -1}));
  EXPECT_EQ(mice.take_presses(), 2u);

  device.unplug();
  later(10);
  EXPECT_FALSE(mice.any());
  EXPECT_TRUE(mice.motion().at_rest());
  EXPECT_EQ(mice.trouble(), "");
  device.plug();
  later(1000);
  device.send({{1, 0, 0, 0, 0, 0xA2, 0xFE}});
  later(10);
  EXPECT_EQ(mice.motion().shift, (std::array<double, 3>{0, 0, -1}));
}

}  // namespace
}  // namespace prismesh::drivers::space_mouse
