// Receives and sends datagrams on the loopback interface. Trackers that are programs (opentrack) send their poses that way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// One datagram. `arrived` with 0 bytes is an empty datagram. A datagram longer than the buffer is truncated; `full_length` is its original
/// length.
struct Datagram {
  bool arrived = false;
  std::size_t bytes = 0;        ///< in the buffer
  std::size_t full_length = 0;  ///< as sent
  PortStatus status = PortStatus::ok;
};

class DatagramPort {
 public:
  virtual ~DatagramPort() = default;
  /// Returns the oldest waiting datagram. Neither blocks nor allocates.
  virtual Datagram receive(std::span<std::byte> to) = 0;
  /// Discards all waiting datagrams.
  virtual void discard_input() = 0;
  virtual int last_error() const = 0;
};

/// Receives on 127.0.0.1:`udp_port` only, so that no datagram from the network reaches the driver. With 0 the system chooses the port
/// number (see `udp_port()`). Errors: another program uses the port number, or this user may not use it.
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

/// Sends to 127.0.0.1:`udp_port`, for simulated trackers. Errors: as UdpPort.
class UdpSender {
 public:
  static Result<std::unique_ptr<UdpSender>> open(std::uint16_t udp_port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Returns false if the system refused the datagram. A missing receiver isn't an error.
  bool send(std::span<const std::byte> datagram);

 private:
  explicit UdpSender(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace prismesh::drivers::port
