// A line to a server on this machine that is cut as a test wants it.
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

namespace prismesh::ipc::remote {

inline sockaddr_in loopback_address(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A listening socket on a free port of this machine.
inline int listen_on_loopback(std::uint16_t& port) {
  const int listening = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback_address(0);
  EXPECT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(listening, 16), 0);
  socklen_t size = sizeof address;
  EXPECT_EQ(::getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size), 0);
  port = ntohs(address.sin_port);
  return listening;
}

inline constexpr std::uint64_t kNeverCut = std::numeric_limits<std::uint64_t>::max();

/// Passes bytes on in both directions, one connection after the other, and cuts each after as many bytes as `next_cut` says: a reset, as of
/// a cable that is pulled.
class CuttingLine {
 public:
  /// `delivers`: what was passed on before a cut arrives.
  CuttingLine(std::uint16_t server, std::function<std::uint64_t()> next_cut, bool delivers = false)
      : server_(server), next_cut_(std::move(next_cut)), delivers_(delivers) {
    listening_ = listen_on_loopback(port_);
    passing_ = std::thread([this] { pass(); });
  }
  ~CuttingLine() {
    ends_ = true;
    passing_.join();
    ::close(listening_);
  }
  CuttingLine(const CuttingLine&) = delete;
  CuttingLine& operator=(const CuttingLine&) = delete;

  std::uint16_t port() const { return port_; }
  std::uint64_t to_server() const { return to_server_; }
  std::uint64_t cuts() const { return cuts_; }

 private:
  static void reset(int socket) {
    const linger at_once{1, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::close(socket);
  }

  void pass() {
    while (!ends_) {
      pollfd waiting{listening_, POLLIN, 0};
      if (::poll(&waiting, 1, 20) != 1) continue;
      const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
      const int server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const sockaddr_in address = loopback_address(server_);
      if (client >= 0 && ::connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) pass_one(client, server);
      if (delivers_)
        ::close(client);
      else
        reset(client);
      reset(server);
    }
  }

  void pass_one(int client, int server) {
    std::uint64_t left = next_cut_();
    char bytes[16384];
    while (!ends_) {
      pollfd both[2] = {{client, POLLIN, 0}, {server, POLLIN, 0}};
      if (::poll(both, 2, 20) <= 0) continue;
      for (int i = 0; i < 2; ++i) {
        if (both[i].revents == 0) continue;
        const ssize_t got = ::recv(both[i].fd, bytes, sizeof bytes, 0);
        if (got <= 0) return;
        if (i == 0) to_server_ += static_cast<std::uint64_t>(got);
        if (static_cast<std::uint64_t>(got) >= left) {
          ++cuts_;
          return;
        }
        left -= static_cast<std::uint64_t>(got);
        if (::send(both[1 - i].fd, bytes, static_cast<std::size_t>(got), MSG_NOSIGNAL) != got) return;
      }
    }
  }

  std::uint16_t server_, port_ = 0;
  std::function<std::uint64_t()> next_cut_;
  bool delivers_ = false;
  int listening_ = -1;
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> to_server_{0}, cuts_{0};
  std::thread passing_;
};

}  // namespace prismesh::ipc::remote
