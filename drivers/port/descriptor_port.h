// A port over a file descriptor in non-blocking mode, used for both ends of pseudo-terminals. Private to drivers/port.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// Returns whether the other end of `descriptor` has hung up. A raw terminal with VMIN 0 returns 0 bytes both without input and at the end,
/// so `read` alone can't tell the two apart.
bool hung_up(int descriptor);

/// Returns whether a terminal surely has no input now. `read` and `poll` on an empty terminal both wait until a kernel thread of ordinary
/// priority has delivered pending input (flush_work); on a busy machine that delayed a real-time loop by many milliseconds. This call
/// doesn't wait. Returns false as well if the answer isn't known: at the end, on an error, or if it isn't a terminal.
bool input_is_empty(int descriptor);
/// Sets a terminal to raw mode without echo. Returns false and sets errno on failure.
bool make_raw(int descriptor);

class DescriptorPort final : public BytePort {
 public:
  /// Takes ownership of `descriptor`, which must be non-blocking. A pseudo-terminal's master must be given `survives_hang_up`: it stays
  /// usable while no process has the slave open.
  explicit DescriptorPort(int descriptor, bool survives_hang_up = false);
  ~DescriptorPort() override;
  DescriptorPort(const DescriptorPort&) = delete;
  DescriptorPort& operator=(const DescriptorPort&) = delete;

  PortCount read(std::span<std::byte> to) override;
  PortCount write(std::span<const std::byte> from) override;
  void discard_input() override;
  bool set_baud(int) override { return true; }
  int last_error() const override { return last_error_; }
  int descriptor() const override { return descriptor_; }

 private:
  PortCount failed(std::size_t bytes, int error);

  int descriptor_;
  bool survives_hang_up_;
  bool gone_ = false;
  int last_error_ = 0;
};

}  // namespace prismesh::drivers::port
