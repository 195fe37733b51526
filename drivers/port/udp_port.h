// Datagrams from this machine: trackers that are programs (opentrack) send their records to a port on the loopback interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// One datagram. `arrived` without bytes is an empty datagram; a datagram longer than the buffer is cut and says its full length.
struct Datagram {
  bool arrived = false;
  std::size_t bytes = 0;        ///< in the buffer
  std::size_t full_length = 0;  ///< as it was sent
  PortStatus status = PortStatus::ok;
};

class DatagramPort {
 public:
  virtual ~DatagramPort() = default;
  /// The oldest datagram that waits; never blocks, never allocates.
  virtual Datagram receive(std::span<std::byte> to) = 0;
  /// Throws away what waits.
  virtual void discard_input() = 0;
  virtual int last_error() const = 0;
};

/// Receives on 127.0.0.1:`udp_port` only, so that nothing from the network reaches the driver; 0 lets the system choose
/// (`UdpPort::udp_port` tells). Errors: the port number is taken by another program, or isn't allowed to this user.
class UdpPort final : public DatagramPort {
 public:
  static Result<std::unique_ptr<UdpPort>> open(std::uint16_t udp_port);
  ~UdpPort() override;
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  Datagram receive(std::span<std::byte> to) override;
  void discard_input() override;
  int last_error() const override { return last_error_; }
  std::uint16_t udp_port() const { return udp_port_; }

 private:
  UdpPort(int descriptor, std::uint16_t udp_port) : descriptor_(descriptor), udp_port_(udp_port) {}
  int descriptor_;
  std::uint16_t udp_port_;
  int last_error_ = 0;
};

/// Sends to 127.0.0.1:`udp_port`: what a simulated tracker does.
class UdpSender {
 public:
  static Result<std::unique_ptr<UdpSender>> open(std::uint16_t udp_port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False: the system didn't take it. Nobody listening isn't an error, as in life.
  bool send(std::span<const std::byte> datagram);

 private:
  explicit UdpSender(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace prismesh::drivers::port
