// Opens a device's port by its path: a serial line through libserialport, or a pseudo-terminal through a file descriptor. Opening may block
// for milliseconds and allocates, so do it outside a tick (port_keeper.h). An open port is exclusive: a second opener, in this or another
// process, is refused.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

struct SerialSettings {
  int baud = 9600;  ///< with 8 data bits, no parity, 1 stop bit and no flow control, which every supported device uses
};

/// Returns whether `path` (links followed) is the slave of a pseudo-terminal.
bool is_pseudo_terminal(const std::string& path);

/// Opens a serial line in raw mode through libserialport. Follows links such as /dev/serial/by-id/.. and discards queued input. Errors name
/// `path` and say what to do: no such device, no permission, busy (and by which program), not a serial line, unsupported baud rate.
Result<std::unique_ptr<BytePort>> open_serial_port(const std::string& path, const SerialSettings& settings);

/// Opens a pseudo-terminal's slave, raw and without echo, and never makes it the process's controlling terminal. libserialport refuses
/// pseudo-terminals: they have no entry in /sys/class/tty and no modem lines. Errors: as above.
Result<std::unique_ptr<BytePort>> open_terminal_port(const std::string& path);

/// Opens `path` as one of the two above, depending on its type. A pseudo-terminal ignores `baud`.
Result<std::unique_ptr<BytePort>> open_port(const std::string& path, int baud);

}  // namespace prismesh::drivers::port
