#include "drivers/port/pty_pair.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/port/descriptor_port.h"

namespace prismesh::drivers::port {

namespace {

tl::unexpected<Error> no_pair(const char* call, int error) {
  return fail("/dev/ptmx", std::string("no pseudo-terminal for a simulated device: ") + call + ": " + std::strerror(error));
}

}  // namespace

Result<PtyPair> open_pty_pair() {
  const int master = ::open("/dev/ptmx", O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master < 0) return no_pair("open", errno);
  PtyPair pair{std::make_unique<DescriptorPort>(master, true), {}};
  if (::grantpt(master) != 0) return no_pair("grantpt", errno);
  if (::unlockpt(master) != 0) return no_pair("unlockpt", errno);
  std::array<char, 64> name{};
  if (const int error = ::ptsname_r(master, name.data(), name.size()); error != 0) return no_pair("ptsname", error);
  pair.slave_path = name.data();
  // Echo is on by default: it would return the simulator's output to the simulator as commands until the driver opens the slave.
  if (!make_raw(master)) return no_pair("tcsetattr", errno);
  return pair;
}

}  // namespace prismesh::drivers::port
