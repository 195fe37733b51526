// Opens a pseudo-terminal for a simulated device: the simulator holds the master, and the driver opens the slave by its path like a serial
// line.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

struct PtyPair {
  /// Never `gone`: while no process has the slave open, reads return nothing, and written bytes are queued or refused.
  std::unique_ptr<BytePort> master;
  std::string slave_path;  ///< /dev/pts/N; exists as long as the master, so closing the master simulates an unplug
};

/// Opens a pair in raw mode without echo. Errors: the system has no pseudo-terminal left (with the failed call and its reason).
Result<PtyPair> open_pty_pair();

}  // namespace prismesh::drivers::port
