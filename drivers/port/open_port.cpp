#include "drivers/port/open_port.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>

#include "drivers/port/descriptor_port.h"
#include "drivers/port/open_error.h"

namespace prismesh::drivers::port {

bool is_pseudo_terminal(const std::string& path) {
  struct stat what {};
  if (::stat(path.c_str(), &what) != 0 || !S_ISCHR(what.st_mode)) return false;
  const unsigned number = major(what.st_rdev);
  return number >= 136 && number <= 143;  // major numbers of Unix98 pseudo-terminal slaves (the kernel's list of devices)
}

Result<std::unique_ptr<BytePort>> open_terminal_port(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return fail(open_error(path, errno));
  auto port = std::make_unique<DescriptorPort>(descriptor);
  if (const int error = lock(descriptor); error != 0) return fail(open_error(path, error));
  if (!make_raw(descriptor)) return fail(open_error(path, errno));
  port->discard_input();
  return port;
}

Result<std::unique_ptr<BytePort>> open_port(const std::string& path, int baud) {
  if (is_pseudo_terminal(path)) return open_terminal_port(path);
  return open_serial_port(path, {baud});
}

}  // namespace prismesh::drivers::port
