// Talks to a USB device that has one bulk endpoint each way: through libusb (open_usb_port), or in memory for tests (memory_usb.h). Calls
// neither block nor allocate, so they may be made in a real-time tick: an I/O thread beside the tick carries the bytes. Opening and closing
// may do both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// A packet of a bulk endpoint at full speed.
inline constexpr std::size_t kUsbPacketBytes = 64;
/// So many packets wait for the bus, or for the reader.
inline constexpr std::size_t kUsbPackets = 16;
inline constexpr std::int64_t kUsbForever = std::numeric_limits<std::int64_t>::max();

/// A request on the control endpoint to the device, without data.
struct UsbControl {
  std::uint8_t type = 0x40;  ///< bmRequestType; the default: to a vendor's device
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  bool operator==(const UsbControl&) const = default;
};

class UsbPort {
 public:
  virtual ~UsbPort() = default;
  /// Returns the oldest packet that has arrived, whole; 0 bytes: none. `to` holds kUsbPacketBytes.
  virtual PortCount read(std::span<std::byte> to) = 0;
  /// Sends at most kUsbPacketBytes as one transfer, after all that was sent before. `full`: nothing was taken. A packet that couldn't be
  /// handed to the bus until `valid_until_ns` (CLOCK_MONOTONIC) is dropped.
  virtual PortStatus write(std::span<const std::byte> packet, std::int64_t valid_until_ns = kUsbForever) = 0;
  /// Makes a request after all that was sent before. A request that the device refuses makes the port `gone`.
  virtual PortStatus control(const UsbControl& request) = 0;
  /// Packets and requests that wait, or that the bus hasn't finished.
  virtual std::size_t pending() const = 0;
  /// How many were finished since the port was opened, dropped ones included.
  virtual std::uint64_t finished() const = 0;
  /// Returns the errno that made the port `gone`; 0: it isn't gone.
  virtual int last_error() const = 0;
  /// Returns the descriptor of the device with its claimed interface, for a process that keeps a duplicate; -1: there is none.
  virtual int descriptor() const { return -1; }
};

/// Which device, and how a user calls it.
struct UsbWanted {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;          ///< for sentences: "Novint Falcon"
  std::string product_text;  ///< what the device must call itself, if it calls itself anything; empty: anything
  std::uint8_t out_endpoint = 0x02;
  std::uint8_t in_endpoint = 0x81;
};

/// Encloses the hand-over of each packet to the kernel, for a process that also sends on the descriptor: what `begin` refuses is dropped.
/// Called by the I/O thread. Neither may block.
struct UsbGate {
  std::function<bool()> begin = [] { return true; };
  std::function<void()> end = [] {};
};

/// Opens the one device of this kind through libusb and discards what it had queued. Its I/O thread runs until the port is destroyed, which
/// first sends what waits (for at most 100 ms). Errors, each a sentence: no such device, two of them, another model with the same numbers,
/// no permission (names the udev rule), another program has it, it doesn't answer.
/// `realtime_priority`: of the I/O thread, where the system grants it; 0: an ordinary one.
Result<std::unique_ptr<UsbPort>> open_usb_port(const UsbWanted& wanted, UsbGate gate = {}, int realtime_priority = 0);

/// Watches on a context and a thread of its own for devices that come and go. Where the system reports none (a container, a network
/// namespace), the counts stay 0: callers must also try from time to time.
class UsbWatch {
 public:
  virtual ~UsbWatch() = default;
  virtual std::uint64_t arrived() const = 0;  ///< since the watch began; devices that were there at the start count too
  virtual std::uint64_t left() const = 0;
};
/// Errors: libusb can't be used here, with its reason.
Result<std::unique_ptr<UsbWatch>> watch_usb(const UsbWanted& wanted);

}  // namespace prismesh::drivers::port
