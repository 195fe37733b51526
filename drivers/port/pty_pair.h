// A pseudo-terminal for a simulated device: the simulator holds the master, the driver opens the slave by its path as it would a serial
// line.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

struct PtyPair {
  std::unique_ptr<BytePort>
      master;              ///< never `gone`: while no one has the slave open, reads are empty and written bytes wait or are refused
  std::string slave_path;  ///< /dev/pts/N; gone with the master, which is how a simulated device is unplugged
};

/// Raw, without echo. Errors: the system has no pseudo-terminal left (the error says which call failed and why).
Result<PtyPair> open_pty_pair();

}  // namespace prismesh::drivers::port
