#include "drivers/port/udp_port.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/port/allocations.h"
#include "tests/drivers/port/bytes.h"

namespace prismesh::drivers::port {
namespace {

struct Station {
  std::unique_ptr<UdpPort> port = std::move(*UdpPort::open(0));
  std::unique_ptr<UdpSender> sender = std::move(*UdpSender::open(port->udp_port()));
};

TEST(UdpPort, returns_datagrams_one_by_one) {
  Station station;
  std::array<std::byte, 64> buffer{};
  EXPECT_FALSE(station.port->receive(buffer).arrived);
  EXPECT_TRUE(station.sender->send(bytes_of("first")));
  EXPECT_TRUE(station.sender->send(bytes_of("second one")));
  const Datagram first = station.port->receive(buffer);
  EXPECT_TRUE(first.arrived);
  EXPECT_EQ(first.bytes, 5u);
  EXPECT_EQ(station.port->receive(buffer).bytes, 10u);
  EXPECT_FALSE(station.port->receive(buffer).arrived);
}

TEST(UdpPort, distinguishes_truncated_empty_and_no_datagrams) {
  Station station;
  std::array<std::byte, 4> buffer{};
  station.sender->send(bytes_of("too long"));
  const Datagram cut = station.port->receive(buffer);
  EXPECT_EQ(cut.bytes, 4u);
  EXPECT_EQ(cut.full_length, 8u);
  station.sender->send({});
  const Datagram empty = station.port->receive(buffer);
  EXPECT_TRUE(empty.arrived);
  EXPECT_EQ(empty.bytes, 0u);
}

TEST(UdpPort, discard_keeps_only_later_datagrams) {
  Station station;
  for (int i = 0; i < 50; ++i) station.sender->send(bytes_of("old"));
  station.port->discard_input();
  std::array<std::byte, 64> buffer{};
  EXPECT_FALSE(station.port->receive(buffer).arrived);
  station.sender->send(bytes_of("newer"));
  EXPECT_EQ(station.port->receive(buffer).bytes, 5u);
}

TEST(UdpPort, reports_a_port_number_in_use) {
  Station station;
  const auto second = UdpPort::open(station.port->udp_port());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().file, "UDP 127.0.0.1:" + std::to_string(station.port->udp_port()));
  EXPECT_THAT(second.error().message, testing::HasSubstr("another program listens there already"));
}

TEST(UdpPort, a_sender_without_receiver_continues) {
  std::uint16_t number = 0;
  {
    const Station station;
    number = station.port->udp_port();
  }
  const auto sender = *UdpSender::open(number);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sender->send(bytes_of("nobody hears")));
  const auto port = UdpPort::open(number);
  ASSERT_TRUE(port) << port.error().text();
  std::array<std::byte, 64> buffer{};
  EXPECT_TRUE(sender->send(bytes_of("now")));
  EXPECT_EQ((*port)->receive(buffer).bytes, 3u);
}

/// Returns an address of this machine on the network; 0 if it has none.
in_addr_t network_address() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return 0;
  in_addr_t found = 0;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next)
    if (one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET) {
      const in_addr_t address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr;
      if (ntohl(address) >> 24 != 127) found = address;
    }
  ::freeifaddrs(all);
  return found;
}

TEST(UdpPort, receives_from_this_machine_only) {
  const in_addr_t outside = network_address();
  if (outside == 0) GTEST_SKIP() << "this machine has no address but the loopback's";
  Station station;
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(station.port->udp_port());
  to.sin_addr.s_addr = outside;
  ::sendto(descriptor, "intruder", 8, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  ::close(descriptor);
  std::array<std::byte, 64> buffer{};
  EXPECT_FALSE(station.port->receive(buffer).arrived);
}

TEST(UdpPort, receiving_allocates_nothing) {
  Station station;
  std::array<std::byte, 48> buffer{};
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) {
    station.sender->send(buffer);
    station.port->receive(buffer);
    station.port->receive(buffer);
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

}  // namespace
}  // namespace prismesh::drivers::port
