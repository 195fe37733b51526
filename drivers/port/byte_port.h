// A device's bytes, whatever carries them: a serial line (libserialport), a pseudo-terminal, or memory in tests. Calls never block
// and never allocate, so that they may stand in a real-time tick; opening and closing may do both and belong outside. The one exception is
// `set_baud`: an adapter takes a millisecond for it and libserialport allocates, so it's for looking for a device, not for its work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace prismesh::drivers::port {

enum class PortStatus : std::uint8_t {
  ok,
  full,  ///< not all bytes were taken; the device or the line is slower than the writer
  gone,  ///< unplugged, hung up, or an I/O error: the port is of no more use and has to be opened again
};

struct PortCount {
  std::size_t bytes = 0;
  PortStatus status = PortStatus::ok;
};

class BytePort {
 public:
  virtual ~BytePort() = default;
  /// What has arrived, as much as fits; 0 bytes with `ok` when there is nothing.
  virtual PortCount read(std::span<std::byte> to) = 0;
  /// Hands bytes to the line; with `full` only the first `bytes` were taken.
  virtual PortCount write(std::span<const std::byte> from) = 0;
  /// Throws away what arrived before now: backlog that queued while nobody listened.
  virtual void discard_input() = 0;
  /// Changes the line's speed; meaningless (and true) where there is no line. False: the port can't.
  virtual bool set_baud(int baud) = 0;
  /// The errno of what made it `gone`, 0 for a plain end.
  virtual int last_error() const = 0;
};

}  // namespace prismesh::drivers::port
