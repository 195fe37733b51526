// Simulates a serial cable in memory, for tests in virtual time: bytes arrive when a line of that baud rate would have delivered them, and
// the cable can be unplugged after any byte. Reading and writing don't allocate. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// The defaults describe a line at 9600 baud whose driver delivers bytes without delay.
struct MemoryLineSettings {
  int host_baud = 9600;            ///< initial baud rate of the host's end
  int device_baud = 9600;          ///< baud rate of the device; if it differs from the host's, bytes arrive scrambled
  std::int64_t latency_ns = 0;     ///< added to the transmission time in each direction, for example an FTDI chip's timer or a USB frame
  std::size_t queue_bytes = 4096;  ///< max. bytes in transit; further writes return `full`
  std::size_t input_bytes = 4096;  ///< max. bytes received and not yet read; further bytes are lost, as in the kernel's buffer
};

enum class Direction : std::uint8_t { to_host, to_device };

class MemoryLine {
 public:
  MemoryLine(Clock& clock, MemoryLineSettings settings);
  ~MemoryLine();
  MemoryLine(const MemoryLine&) = delete;
  MemoryLine& operator=(const MemoryLine&) = delete;

  /// Opens the host's end, as opening a device file does. The end becomes `gone` for good after an unplug or after a later open. Opening
  /// discards queued input. The end must not outlive the line. `baud` defaults to the settings' host_baud. Errors: unplugged (the same
  /// sentence as for ENOENT).
  Result<std::unique_ptr<BytePort>> open_host(std::optional<int> baud = std::nullopt);
  /// Returns the device's end. It doesn't report an unplug: then its writes are lost, and nothing arrives.
  BytePort& device();

  /// Unplugs now. Bytes for the host are lost, read or not. Bytes that the host has written still reach the device, so the device may
  /// receive half a message.
  void unplug();
  /// Unplugs after the host has read (to_host) or written (to_device) `count` more bytes; 0 unplugs now.
  void unplug_after(Direction direction, std::size_t count);
  void plug_in();
  bool plugged_in() const { return plugged_in_; }

  /// Inserts noise bytes behind the bytes in transit. They take their transmission time like other bytes.
  void inject(Direction direction, std::span<const std::byte> bytes);
  /// From now on inverts one bit of each byte with probability `flip_chance`, and loses each byte with probability `loss_chance`; 0 and 0
  /// switches noise off. The same seed gives the same noise.
  void set_noise(double flip_chance, double loss_chance, std::uint64_t seed);

  /// Returns the number of bytes lost so far because the input buffer was full.
  std::uint64_t overrun(Direction direction) const;
  /// Returns when the next byte in transit can be read; nothing if no byte is in transit.
  std::optional<std::int64_t> next_arrival_ns(Direction direction) const;

 private:
  class Lane;
  class HostEnd;
  class DeviceEnd;
  Lane& lane(Direction direction) const { return direction == Direction::to_host ? *to_host_ : *to_device_; }

  std::size_t allowed(Direction direction, std::size_t wanted) const;
  void count(Direction direction, std::size_t bytes);

  Clock& clock_;
  MemoryLineSettings settings_;
  int host_baud_, device_baud_;
  std::unique_ptr<Lane> to_host_, to_device_;
  std::unique_ptr<DeviceEnd> device_;
  std::optional<std::size_t> remaining_to_host_, remaining_to_device_;  // bytes until the cable is unplugged
  std::uint64_t generation_ = 0;                                        // of the host's end; an end of an older generation is gone
  bool plugged_in_ = true;
};

}  // namespace prismesh::drivers::port
