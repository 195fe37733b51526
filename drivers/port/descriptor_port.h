// A port over a file descriptor in non-blocking mode: what pseudo-terminals, both ends, are. Private to drivers/port.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// Whether the other end of `descriptor` has hung up. A raw terminal that waits for no byte (VMIN 0) reads nothing and reads the end
/// alike, so reading alone can't tell.
bool hung_up(int descriptor);

/// Whether nothing can be read from a terminal now. Reading and polling one that has nothing both wait until a thread of the kernel's, of
/// ordinary priority, has handed over what is on its way (flush_work); on a busy machine that took a real-time loop many milliseconds. This
/// question doesn't wait. False as well where it isn't known: on an end, an error, no terminal.
bool surely_nothing_there(int descriptor);
/// Raw mode without echo on a terminal, whatever it was before. False with errno set.
bool make_raw(int descriptor);

class DescriptorPort final : public BytePort {
 public:
  /// Owns `descriptor`, which must be non-blocking. A master's end outlives its slaves (`survives_hang_up`): it isn't gone when nobody has
  /// the slave open.
  explicit DescriptorPort(int descriptor, bool survives_hang_up = false);
  ~DescriptorPort() override;
  DescriptorPort(const DescriptorPort&) = delete;
  DescriptorPort& operator=(const DescriptorPort&) = delete;

  PortCount read(std::span<std::byte> to) override;
  PortCount write(std::span<const std::byte> from) override;
  void discard_input() override;
  bool set_baud(int) override { return true; }
  int last_error() const override { return last_error_; }

 private:
  PortCount failed(std::size_t bytes, int error);

  int descriptor_;
  bool survives_hang_up_;
  bool gone_ = false;
  int last_error_ = 0;
};

}  // namespace prismesh::drivers::port
