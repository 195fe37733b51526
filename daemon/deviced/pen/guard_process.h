// The watchdog of the pen's line, as the forked process runs it. Calls only what may be called after a fork; allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/deviced/pen/guard_page.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::deviced::pen {

/// The heartbeat may be missing for so long.
inline constexpr std::int64_t kMaxSilenceNs = 10'000'000;

/// Length of what sets a device's force to zero.
inline constexpr std::size_t kMaxZeroBytes = 160;

/// What the loop's process tells the guard. The end of the socket says that the process has died.
enum class GuardWord : char { line = 'L', usb = 'U', stream = 'S', release = 'R', end = 'E' };

/// A word; `line`, `usb` and `stream` come with a descriptor. To a USB device the guard sends `zero` through the kernel's own interface:
/// the descriptor has the interface claimed, and libusb may not be used after a fork. A stream is a connection to a service: it is sent
/// `zero`, and ended some time after the other process.
struct GuardMessage {
  GuardWord word = GuardWord::end;
  std::uint8_t endpoint = 0;
  std::uint8_t zero_bytes = 0;
  std::array<std::byte, kMaxZeroBytes> zero{};
};

/// Never returns. `socket`: to the loop's process. `lock`: an open file that this process locks while it lives, so that a later guard's
/// parent can find it. Closes all other descriptors.
[[noreturn]] void run_guard(GuardPage& page, int socket, int lock, int parent);

}  // namespace prismesh::deviced::pen
