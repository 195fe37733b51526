// A serial cable in memory, for tests in virtual time: bytes arrive when a line of that speed would have delivered them, and the cable can
// be pulled at any byte. Reading and writing never allocate. For one thread.
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

/// Defaults are a line at 9600 baud behind a driver that hands bytes over at once.
struct MemoryLineSettings {
  int host_baud = 9600;            ///< what the host's end is opened with
  int device_baud = 9600;          ///< what the device speaks; where the two differ, bytes arrive scrambled
  std::int64_t latency_ns = 0;     ///< on top of the bytes' own time, per direction: an FTDI chip's timer, a USB frame
  std::size_t queue_bytes = 4096;  ///< a writer may be this far ahead of the line; beyond it its write is `full`
  std::size_t input_bytes = 4096;  ///< what arrived and isn't read; newer bytes are lost, as in the kernel's own buffer
};

enum class Direction : std::uint8_t { to_host, to_device };

class MemoryLine {
 public:
  MemoryLine(Clock& clock, MemoryLineSettings settings);
  ~MemoryLine();
  MemoryLine(const MemoryLine&) = delete;
  MemoryLine& operator=(const MemoryLine&) = delete;

  /// The host's end, as opening a device file gives it: refused while unplugged (ENOENT's sentence), `gone` for good after an unplug or
  /// when a later one was opened. Opening throws away what had queued. Must not outlive the line. Without `baud`: the settings' host_baud.
  Result<std::unique_ptr<BytePort>> open_host(std::optional<int> baud = std::nullopt);
  /// The device's end. A device doesn't notice a pulled cable: what it writes is lost, and nothing comes.
  BytePort& device();

  /// At once. Bytes for the host are lost, read or not; those it had handed over still reach the device, so that a device may be left with
  /// half a message.
  void unplug();
  /// When `count` more bytes have been read by the host (to_host) or accepted from it (to_device); 0 is at once.
  void unplug_after(Direction direction, std::size_t count);
  void plug_in();
  bool plugged_in() const { return plugged_in_; }

  /// Noise: bytes that nobody sent, on the line behind those under way; they take its time like others.
  void inject(Direction direction, std::span<const std::byte> bytes);
  /// From now on each byte is, with these chances, hit in one bit or lost; 0 and 0 is a quiet line. Same seed, same noise.
  void set_noise(double flip_chance, double loss_chance, std::uint64_t seed);

  /// Bytes lost for want of input space, since the beginning.
  std::uint64_t overrun(Direction direction) const;
  /// When the next byte will be there to read, if any is under way.
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
  std::optional<std::size_t> left_to_host_, left_to_device_;  // until the cable is pulled
  std::uint64_t incarnation_ = 0;                             // of the host's end: an older one is gone
  bool plugged_in_ = true;
};

}  // namespace prismesh::drivers::port
