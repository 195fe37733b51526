#include "drivers/port/udp_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace prismesh::drivers::port {

namespace {

sockaddr_in loopback(std::uint16_t udp_port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(udp_port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int open_socket() { return ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

tl::unexpected<Error> no_socket(std::uint16_t udp_port, int error) {
  const std::string name = "UDP 127.0.0.1:" + std::to_string(udp_port);
  if (error == EADDRINUSE)
    return fail(name, "another program listens there already; end it (ss -ulp names it), or give this tracker another udp_port");
  if (error == EACCES) return fail(name, "this user may not listen there; choose a udp_port of 1024 or more");
  return fail(name, std::string("can't be opened: ") + std::strerror(error));
}

}  // namespace

Result<std::unique_ptr<UdpPort>> UdpPort::open(std::uint16_t udp_port) {
  const int descriptor = open_socket();
  if (descriptor < 0) return no_socket(udp_port, errno);
  std::unique_ptr<UdpPort> port(new UdpPort(descriptor, udp_port));
  sockaddr_in address = loopback(udp_port);
  socklen_t length = sizeof address;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), length) != 0) return no_socket(udp_port, errno);
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &length) != 0) return no_socket(udp_port, errno);
  port->udp_port_ = ntohs(address.sin_port);
  return port;
}

UdpPort::~UdpPort() { ::close(descriptor_); }

Datagram UdpPort::receive(std::span<std::byte> to) {
  ssize_t length = 0;
  do length = ::recv(descriptor_, to.data(), to.size(), MSG_TRUNC);
  while (length < 0 && errno == EINTR);
  if (length >= 0) {
    const auto full = static_cast<std::size_t>(length);
    return {true, full < to.size() ? full : to.size(), full, PortStatus::ok};
  }
  if (errno == EAGAIN || errno == EWOULDBLOCK) return {};
  last_error_ = errno;
  return {false, 0, 0, PortStatus::gone};
}

void UdpPort::discard_input() {
  std::array<std::byte, 1> discarded{};
  // Bounded, so that a flood of datagrams can't block the caller: a full socket buffer holds fewer.
  for (int i = 0; i < 4096 && receive(discarded).arrived; ++i) {
  }
}

Result<std::unique_ptr<UdpSender>> UdpSender::open(std::uint16_t udp_port) {
  const int descriptor = open_socket();
  if (descriptor < 0) return no_socket(udp_port, errno);
  std::unique_ptr<UdpSender> sender(new UdpSender(descriptor));
  const sockaddr_in address = loopback(udp_port);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return no_socket(udp_port, errno);
  return sender;
}

UdpSender::~UdpSender() { ::close(descriptor_); }

bool UdpSender::send(std::span<const std::byte> datagram) {
  // A connected socket reports an earlier undelivered datagram by refusing the current one once, so this one is sent again.
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::send(descriptor_, datagram.data(), datagram.size(), MSG_NOSIGNAL) >= 0) return true;
    if (errno != ECONNREFUSED) return false;
  }
  return true;
}

}  // namespace prismesh::drivers::port
