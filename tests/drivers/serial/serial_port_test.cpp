// The real libserialport on a serial adapter simulated by umockdev.
#include <unistd.h>

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/port/keeper_thread.h"
#include "drivers/port/open_port.h"
#include "tests/drivers/port/bytes.h"
#include "tests/drivers/serial/fake_line.h"

namespace prismesh::drivers::port {
namespace {

class SerialPortTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(FakeLine::possible()) << "run me under umockdev-wrapper"; }
  FakeLine line_{"FTDI_USB__-__Serial_Converter_FT4THUGO"};
};

TEST_F(SerialPortTest, opens_raw_8n1_without_flow_control_at_the_given_baud_rate) {
  line_.plug_in();
  EXPECT_FALSE(is_pseudo_terminal(line_.path()));
  for (const int baud : {9600, 19'200, 57'600, 1'000'000, 140'000}) {
    const auto port = open_port(line_.path(), baud);
    ASSERT_TRUE(port) << port.error().text();
    const LineState state = line_.state();
    EXPECT_EQ(state.baud, baud);
    EXPECT_TRUE(state.raw);
    EXPECT_TRUE(state.eight_n_one);
    EXPECT_FALSE(state.flow_control);
    EXPECT_TRUE(state.exclusive);
  }
  EXPECT_THAT(line_.state().unknown_requests, testing::IsEmpty());
}

TEST_F(SerialPortTest, changes_its_baud_rate_while_open) {
  line_.plug_in();
  const auto port = *open_port(line_.path(), 57'600);
  EXPECT_TRUE(port->set_baud(1'000'000));
  EXPECT_EQ(line_.state().baud, 1'000'000);
}

TEST_F(SerialPortTest, transfers_bytes_both_ways) {
  line_.plug_in();
  const auto port = *open_port(line_.path(), 19'200);
  const std::string text("\x03\x11\x13\x1a\r\n\0\xff plain", 14);
  const PortCount put = port->write(bytes_of(text));
  EXPECT_EQ(put.status, PortStatus::ok);
  EXPECT_EQ(put.bytes, text.size());
  EXPECT_EQ(line_.receive(text.size()), text);
  line_.send("record");
  EXPECT_EQ(read_soon(*port, 6), "record");
  std::array<std::byte, 8> buffer{};
  const PortCount nothing = port->read(buffer);
  EXPECT_EQ(nothing.status, PortStatus::ok);
  EXPECT_EQ(nothing.bytes, 0u);
}

TEST_F(SerialPortTest, opens_by_its_stable_name) {
  line_.plug_in();
  const auto port = open_port(line_.by_id_path(), 19'200);
  ASSERT_TRUE(port) << port.error().text();
  line_.send("hello");
  EXPECT_EQ(read_soon(**port, 5), "hello");
}

TEST_F(SerialPortTest, discards_queued_input) {
  line_.plug_in();
  line_.send("stale");
  const auto port = *open_port(line_.path(), 19'200);
  line_.send("fresh");
  EXPECT_EQ(read_soon(*port, 5), "fresh");
}

TEST_F(SerialPortTest, refuses_a_second_opener) {
  line_.plug_in();
  auto first = open_port(line_.path(), 19'200);
  ASSERT_TRUE(first) << first.error().text();
  const auto second = open_port(line_.path(), 19'200);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().text(), testing::StartsWith(line_.path() + ": another program has it open: "));
  first->reset();
  EXPECT_TRUE(open_port(line_.path(), 19'200));
}

TEST_F(SerialPortTest, reports_a_missing_device_and_lists_the_connected_ones) {
  line_.plug_in();
  const auto port = open_port("/dev/ttyUSB9", 9600);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().text(),
            "/dev/ttyUSB9: there is no such device; is it plugged in and switched on? plugged in now: " + line_.by_id_path());
}

TEST_F(SerialPortTest, an_unplugged_line_is_gone) {
  for (const bool by_reading : {true, false}) {
    line_.plug_in();
    const auto port = *open_port(line_.path(), 19'200);
    line_.unplug();
    std::array<std::byte, 8> buffer{};
    const PortCount count = by_reading ? port->read(buffer) : port->write(buffer);
    EXPECT_EQ(count.status, PortStatus::gone) << (by_reading ? "reading" : "writing");
    EXPECT_FALSE(port->set_baud(9600));
  }
}

TEST_F(SerialPortTest, a_keeper_reopens_it_each_time_it_returns) {
  MonotonicClock clock;
  PortKeeper keeper(
      clock, [&] { return open_port(line_.by_id_path(), 19'200); }, line_.by_id_path());
  const KeeperThread thread(clock, {work_of(keeper)});
  for (int round = 0; round < 5; ++round) {
    line_.plug_in();
    ASSERT_TRUE(eventually([&] { return keeper.port() != nullptr; })) << "round " << round;
    line_.send("hello");
    EXPECT_EQ(read_soon(*keeper.port(), 5), "hello");
    line_.unplug();
    std::array<std::byte, 8> buffer{};
    ASSERT_TRUE(eventually([&] { return keeper.port()->read(buffer).status == PortStatus::gone; }));
    keeper.give_back();
  }
  EXPECT_EQ(keeper.report().openings, 5u);
}

}  // namespace
}  // namespace prismesh::drivers::port
