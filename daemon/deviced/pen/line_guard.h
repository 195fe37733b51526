// Starts the process that guards the pen's line, and hands it duplicates of the line.
#pragma once

#include <sys/types.h>

#include <filesystem>

#include "base/error.h"
#include "daemon/deviced/pen/guard_page.h"
#include "drivers/port/byte_port.h"
#include "drivers/port/usb_port.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::deviced::pen {

class LineGuard {
 public:
  /// Call it before the process has threads. Ends the guard of an earlier process, which kept the device at zero until now. `folder`: of
  /// the pen's state; it holds the guard's lock. Errors: no process or memory; the earlier guard doesn't end.
  static Result<LineGuard> start(const std::filesystem::path& folder);
  LineGuard(LineGuard&& other) noexcept;
  LineGuard& operator=(LineGuard&&) = delete;
  /// The guard writes its last zero frames and ends.
  ~LineGuard();

  GuardPage& page() { return *page_; }
  /// Errors: the line has no descriptor, the guard is gone.
  Result<void> watch(const drivers::port::BytePort& line);
  /// The same for a USB device, which is told `zero` at this endpoint.
  Result<void> watch(const drivers::port::UsbPort& line, std::uint8_t endpoint, std::span<const std::byte> zero);
  /// The same for a connection to a service (a socket), which is told `zero`: at most kMaxZeroBytes.
  Result<void> watch(int connection, std::span<const std::byte> zero);
  void release();
  /// False once the guard has ended: then nobody guards the line.
  bool is_alive();
  pid_t process() const { return process_; }

 private:
  LineGuard() = default;

  GuardPage* page_ = nullptr;
  ipc::Mapping mapping_;
  ipc::Descriptor socket_;
  pid_t process_ = -1;
};

/// A port whose writes take the line's token: while the guard has it, nothing is written and `full` is returned.
class GuardedPort final : public drivers::port::BytePort {
 public:
  GuardedPort(drivers::port::BytePort& line, GuardPage& page) : line_(line), page_(page) {}
  drivers::port::PortCount read(std::span<std::byte> to) override { return line_.read(to); }
  drivers::port::PortCount write(std::span<const std::byte> from) override;
  void discard_input() override { line_.discard_input(); }
  bool set_baud(int baud) override { return line_.set_baud(baud); }
  int last_error() const override { return line_.last_error(); }
  int descriptor() const override { return line_.descriptor(); }

 private:
  drivers::port::BytePort& line_;
  GuardPage& page_;
};

/// The same for a USB device: its I/O thread takes the token for each packet. `page` must outlive the port.
drivers::port::UsbGate usb_gate(GuardPage& page);

}  // namespace prismesh::deviced::pen
