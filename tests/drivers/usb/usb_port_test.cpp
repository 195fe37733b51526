// The real libusb on devices that umockdev simulates.
#include "drivers/port/usb_port.h"

#include <mutex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/simulated_falcon.h"
#include "drivers/port/open_error.h"
#include "tests/drivers/port/bytes.h"
#include "tests/drivers/usb/fake_usb.h"

namespace prismesh::drivers::port {
namespace {

/// Sends back what it gets, with its number of bytes before it.
class EchoDevice final : public UsbDevice {
 public:
  bool control(std::int64_t, const UsbControl& request) override {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    order_ += 'c';
    return request.request != 0xEE;
  }
  void receive(std::int64_t, std::span<const std::byte> bytes) override {
    const std::lock_guard lock(mutex_);
    order_ += 'w';
    std::string packet;
    for (const std::byte each : bytes) packet += static_cast<char>(each);
    packets_.push_back(packet);
  }
  std::size_t send(std::int64_t, std::span<std::byte> to) override {
    const std::lock_guard lock(mutex_);
    if (packets_.empty()) return 0;
    const std::string packet = packets_.front();
    packets_.erase(packets_.begin());
    std::transform(packet.begin(), packet.end(), to.begin(), [](char each) { return static_cast<std::byte>(each); });
    return packet.size();
  }
  std::vector<UsbControl> requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
  }
  std::string order() const {
    const std::lock_guard lock(mutex_);
    return order_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> packets_;
  std::vector<UsbControl> requests_;
  std::string order_;
};

class UsbPortTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(FakeUsb::possible()) << "run me under umockdev-wrapper"; }
  static UsbWanted wanted() { return haptic_pen::falcon::falcon_wanted(); }
  static std::string read_packet(UsbPort& port) {
    std::array<std::byte, kUsbPacketBytes> packet{};
    std::size_t count = 0;
    eventually([&] {
      const PortCount got = port.read(packet);
      count = got.bytes;
      return got.bytes > 0 || got.status == PortStatus::gone;
    });
    return {reinterpret_cast<const char*>(packet.data()), count};
  }

  FakeUsb bus_;
  EchoDevice echo_;
};

TEST_F(UsbPortTest, carries_packets_both_ways_in_their_order) {
  bus_.plug_in(echo_);
  const auto port = open_usb_port(wanted());
  ASSERT_TRUE(port) << port.error().text();
  EXPECT_GE((*port)->descriptor(), 0);
  for (int i = 0; i < 100; ++i) {
    const std::string text = "packet " + std::to_string(i) + std::string(static_cast<std::size_t>(i % 50), 'x');
    ASSERT_EQ((*port)->write(bytes_of(text)), PortStatus::ok);
    EXPECT_EQ(read_packet(**port), text);
  }
  // Two and more on their way.
  for (int i = 0; i < 8; ++i) ASSERT_EQ((*port)->write(bytes_of(std::string(1, static_cast<char>('a' + i)))), PortStatus::ok);
  std::string all;
  for (int i = 0; i < 8; ++i) all += read_packet(**port);
  EXPECT_EQ(all, "abcdefgh");
}

TEST_F(UsbPortTest, keeps_requests_between_the_packets_where_they_were) {
  bus_.plug_in(echo_);
  const auto port = *open_usb_port(wanted());
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(port->control({.request = 3, .value = static_cast<std::uint16_t>(0x4138 + i), .index = 1}), PortStatus::ok);
    ASSERT_EQ(port->write(bytes_of("x")), PortStatus::ok);
  }
  EXPECT_TRUE(eventually([&] { return port->pending() == 0; }));
  EXPECT_EQ(echo_.order(), "cwcwcw");
  EXPECT_EQ(echo_.requests().at(1), (UsbControl{0x40, 3, 0x4139, 1}));
}

TEST_F(UsbPortTest, takes_no_more_than_its_queue_holds) {
  bus_.plug_in(echo_);
  UsbGate shut;
  const auto port = *open_usb_port(wanted());
  bool full = false;
  for (std::size_t i = 0; i < 10'000 && !full; ++i) full = port->write(bytes_of("y")) == PortStatus::full;
  EXPECT_TRUE(full);
  EXPECT_TRUE(eventually([&] { return port->pending() == 0; }));
}

TEST_F(UsbPortTest, drops_what_is_too_old_and_what_the_gate_refuses) {
  bus_.plug_in(echo_);
  std::atomic<bool> open = true;
  std::atomic<int> begun = 0, ended = 0;
  const auto port = *open_usb_port(wanted(), {[&] { return open ? ++begun > 0 : false; }, [&] { ++ended; }});
  ASSERT_EQ(port->write(bytes_of("old"), 1), PortStatus::ok);
  ASSERT_EQ(port->write(bytes_of("new")), PortStatus::ok);
  EXPECT_EQ(read_packet(*port), "new");
  open = false;
  ASSERT_EQ(port->write(bytes_of("shut")), PortStatus::ok);
  EXPECT_TRUE(eventually([&] { return port->pending() == 0; }));
  open = true;
  ASSERT_EQ(port->write(bytes_of("open")), PortStatus::ok);
  EXPECT_EQ(read_packet(*port), "open");
  EXPECT_EQ(begun, ended);
  EXPECT_EQ(begun, 2);
}

TEST_F(UsbPortTest, sends_what_waits_before_it_closes) {
  bus_.plug_in(echo_);
  {
    const auto port = *open_usb_port(wanted());
    for (int i = 0; i < 5; ++i) ASSERT_EQ(port->write(bytes_of("zero")), PortStatus::ok);
  }
  EXPECT_EQ(echo_.order(), "wwwww");
  // And it can be opened again.
  const auto again = open_usb_port(wanted());
  ASSERT_TRUE(again) << again.error().text();
}

TEST_F(UsbPortTest, an_unplugged_device_is_gone_and_comes_back) {
  for (int round = 0; round < 3; ++round) {
    const int number = bus_.plug_in(echo_);
    const auto port = open_usb_port(wanted());
    ASSERT_TRUE(port) << port.error().text();
    ASSERT_EQ((*port)->write(bytes_of("here")), PortStatus::ok);
    EXPECT_EQ(read_packet(**port), "here");
    bus_.unplug(number);
    std::array<std::byte, kUsbPacketBytes> packet{};
    EXPECT_TRUE(eventually([&] { return (*port)->read(packet).status == PortStatus::gone; }));
    EXPECT_EQ((*port)->last_error(), ENODEV);
    EXPECT_EQ((*port)->write(bytes_of("gone")), PortStatus::gone);
  }
}

TEST_F(UsbPortTest, a_refused_request_ends_it) {
  bus_.plug_in(echo_);
  const auto port = *open_usb_port(wanted());
  ASSERT_EQ(port->control({.request = 0xEE}), PortStatus::ok);
  EXPECT_TRUE(eventually([&] { return port->last_error() == EIO; }));
}

TEST_F(UsbPortTest, each_thing_that_can_be_wrong_has_its_sentence) {
  EXPECT_EQ(open_usb_port(wanted()).error().text(),
            "Novint Falcon (USB 0403:cb48): there is no such device; is it plugged in, and has it its own power supply?");
  const int first = bus_.plug_in(echo_);
  const int second = bus_.plug_in(echo_);
  EXPECT_EQ(open_usb_port(wanted()).error().text(),
            "Novint Falcon (USB 0403:cb48): two are plugged in (" + bus_.path(first) + " and " + bus_.path(second) + "): leave one");
  bus_.unplug(second);
  bus_.claim_by_another(first, true);
  EXPECT_THAT(open_usb_port(wanted()).error().text(),
              testing::StartsWith("Novint Falcon (" + bus_.path(first) + "): another program uses it"));
  bus_.unplug(first);
  const int other = bus_.plug_in(echo_, {.product_text = "FT232R USB UART"});
  EXPECT_EQ(
      open_usb_port(wanted()).error().text(),
      bus_.path(other) +
          ": has the numbers of a Novint Falcon (0403:cb48), but calls itself \"FT232R USB UART\", not \"FALCON HAPTIC\": it is another "
          "device, and is left alone");
  bus_.unplug(other);
  const int ends = bus_.plug_in(echo_, {.in_endpoint = 0x83});
  EXPECT_EQ(
      open_usb_port(wanted()).error().text(),
      bus_.path(ends) +
          ": has the numbers of a Novint Falcon (0403:cb48), but doesn't have its endpoints: it is another device, and is left alone");
  EXPECT_THAT(usb_open_error("Novint Falcon", "/dev/bus/usb/001/002", EACCES).text(),
              testing::HasSubstr("install systemd/udev/60-prismesh.rules"));
}

TEST_F(UsbPortTest, a_watch_sees_devices_come_and_go) {
  const auto watch = watch_usb(wanted());
  ASSERT_TRUE(watch) << watch.error().text();
  EXPECT_EQ((*watch)->arrived(), 0u);
  const int number = bus_.plug_in(echo_);
  EXPECT_TRUE(eventually([&] { return (*watch)->arrived() == 1; }));
  bus_.unplug(number);
  EXPECT_TRUE(eventually([&] { return (*watch)->left() == 1; }));
  EchoDevice foreign;
  bus_.plug_in(foreign, {.product = 0x6001});
  bus_.plug_in(echo_);
  EXPECT_TRUE(eventually([&] { return (*watch)->arrived() == 2; }));
}

/// The whole way: libusb, boot sequence, homing, forces.
TEST_F(UsbPortTest, a_falcon_goes_from_its_plug_to_a_force) {
  using namespace haptic_pen;
  std::mutex mutex;
  std::vector<falcon::ForcePacket> seen;
  falcon::SimulatedFalcon device(
      {},
      [](double seconds) {
        SimulatedHand hand;
        hand.goal_mm = {0, 0, 38 * std::sin(4 * seconds)};
        return hand;
      },
      [&](std::int64_t, const falcon::ForcePacket& packet) {
        const std::lock_guard lock(mutex);
        seen.push_back(packet);
      });
  bus_.plug_in(device);
  const auto port = open_usb_port(wanted());
  ASSERT_TRUE(port) << port.error().text();
  falcon::FalconPen pen(**port, {.firmware = falcon::pretended_firmware(1500)});
  MonotonicClock clock;
  PenReading reading;
  const auto tick = [&](const Eigen::Vector3d& newton) {
    const std::int64_t now = clock.now_ns();
    reading = pen.read(now);
    pen.send(now, {newton, now + 100'000'000});
    return reading.phase;
  };
  ASSERT_TRUE(eventually([&] { return tick({0, 0, 0}) == PenPhase::ready; })) << pen.advice();
  EXPECT_TRUE(eventually([&] {
    (void)tick({1, 0, 0});
    const std::lock_guard lock(mutex);
    return !seen.empty() && seen.back().motors != std::array<std::int16_t, 3>{};
  }));
  EXPECT_TRUE(eventually([&] {
    (void)tick({0, 0, 0});
    return reading.fresh;
  }));
  EXPECT_LT(reading.pose.position_mm.norm(), 60);
}

}  // namespace
}  // namespace prismesh::drivers::port
