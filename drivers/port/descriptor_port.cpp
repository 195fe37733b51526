#include "drivers/port/descriptor_port.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>

namespace prismesh::drivers::port {

bool hung_up(int descriptor) {
  pollfd watched{descriptor, 0, 0};  // poll always reports hang-ups and errors
  return ::poll(&watched, 1, 0) > 0 && (watched.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

bool input_is_empty(int descriptor) {
  int waiting = 0;
  return ::ioctl(descriptor, FIONREAD, &waiting) == 0 && waiting == 0;
}

bool make_raw(int descriptor) {
  termios mode{};
  if (::tcgetattr(descriptor, &mode) != 0) return false;
  ::cfmakeraw(&mode);
  mode.c_cflag |= CREAD | CLOCAL;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  return ::tcsetattr(descriptor, TCSANOW, &mode) == 0;
}

DescriptorPort::DescriptorPort(int descriptor, bool survives_hang_up) : descriptor_(descriptor), survives_hang_up_(survives_hang_up) {}

DescriptorPort::~DescriptorPort() { ::close(descriptor_); }

PortCount DescriptorPort::failed(std::size_t bytes, int error) {
  if (survives_hang_up_ && error == EIO) return {bytes, PortStatus::ok};
  gone_ = true;
  last_error_ = error;
  return {bytes, PortStatus::gone};
}

PortCount DescriptorPort::read(std::span<std::byte> to) {
  if (gone_) return {0, PortStatus::gone};
  if (to.empty() || input_is_empty(descriptor_)) return {};
  ssize_t got = 0;
  do got = ::read(descriptor_, to.data(), to.size());
  while (got < 0 && errno == EINTR);
  if (got > 0) return {static_cast<std::size_t>(got), PortStatus::ok};
  if (got == 0) return survives_hang_up_ || !hung_up(descriptor_) ? PortCount{} : failed(0, 0);
  if (errno == EAGAIN || errno == EWOULDBLOCK) return {};
  return failed(0, errno);
}

PortCount DescriptorPort::write(std::span<const std::byte> from) {
  if (gone_) return {0, PortStatus::gone};
  if (from.empty()) return {};
  ssize_t put = 0;
  do put = ::write(descriptor_, from.data(), from.size());
  while (put < 0 && errno == EINTR);
  if (put < 0 && errno != EAGAIN && errno != EWOULDBLOCK) return failed(0, errno);
  const std::size_t bytes = put < 0 ? 0 : static_cast<std::size_t>(put);
  return {bytes, bytes < from.size() ? PortStatus::full : PortStatus::ok};
}

void DescriptorPort::discard_input() {
  if (!gone_) ::tcflush(descriptor_, TCIFLUSH);
}

}  // namespace prismesh::drivers::port
