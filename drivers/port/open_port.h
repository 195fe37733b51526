// Opening a device's port by its path: a serial line through libserialport, or a pseudo-terminal through a plain descriptor. Opening may
// block for milliseconds and allocates; it belongs outside a tick (port_keeper.h). An open port belongs to its opener alone: a second
// opener, in this process or another, is refused.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

struct SerialSettings {
  int baud = 9600;  ///< 8 data bits, no parity, 1 stop bit, no flow control: what every device here speaks
};

/// Whether `path` (links followed) is the slave's end of a pseudo-terminal.
bool is_pseudo_terminal(const std::string& path);

/// A serial line through libserialport, raw; links such as /dev/serial/by-id/.. are followed. What had queued while nobody listened is
/// thrown away. Errors, with `path` as their file, say what to do: nothing there, no permission, busy (and who has it), no serial line, a
/// speed that the line can't do.
Result<std::unique_ptr<BytePort>> open_serial_port(const std::string& path, const SerialSettings& settings);

/// A pseudo-terminal's slave, raw and without echo, never the process's controlling terminal. libserialport refuses these: they have no
/// entry in /sys/class/tty and no modem lines. Errors as above.
Result<std::unique_ptr<BytePort>> open_terminal_port(const std::string& path);

/// One of the two above, chosen by what `path` is; a pseudo-terminal has no line, so `baud` is nothing to it.
Result<std::unique_ptr<BytePort>> open_port(const std::string& path, int baud);

}  // namespace prismesh::drivers::port
