// Reads and writes a device's bytes over any carrier: a serial line (libserialport), a pseudo-terminal, or memory in tests. Calls neither
// block nor allocate, so they may be made in a real-time tick. Opening and closing may do both and must happen outside the tick. `set_baud`
// is the one exception: a USB adapter needs a millisecond for it, and libserialport allocates. Call it while searching for a device, not
// during operation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace prismesh::drivers::port {

enum class PortStatus : std::uint8_t {
  ok,
  full,  ///< not all bytes were accepted: the device or the line is slower than the writer
  gone,  ///< unplugged, hung up, or an I/O error: the port can't be used again and has to be reopened
};

struct PortCount {
  std::size_t bytes = 0;
  PortStatus status = PortStatus::ok;
};

class BytePort {
 public:
  virtual ~BytePort() = default;
  /// Reads the bytes that have arrived, up to the size of `to`. Returns 0 bytes and `ok` if there are none.
  virtual PortCount read(std::span<std::byte> to) = 0;
  /// Passes bytes to the line. With `full`, only the first `bytes` were accepted.
  virtual PortCount write(std::span<const std::byte> from) = 0;
  /// Discards all bytes received so far, for example a backlog from before the port was opened.
  virtual void discard_input() = 0;
  /// Changes the line's baud rate. A port without a line ignores it and returns true. Returns false if the port can't use this rate.
  virtual bool set_baud(int baud) = 0;
  /// Returns the errno that made the port `gone`, 0 after a plain end of file.
  virtual int last_error() const = 0;
  /// Returns the descriptor of the line, for a process that keeps a duplicate of it; -1: there is none.
  virtual int descriptor() const { return -1; }
};

}  // namespace prismesh::drivers::port
