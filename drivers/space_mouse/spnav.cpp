#include "drivers/space_mouse/spnav.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace prismesh::drivers::space_mouse {
namespace {

enum SpnavEventKind : std::int32_t { kSpnavMotion = 0, kSpnavPress = 1, kSpnavRelease = 2 };

/// Without overflow at the smallest integer.
int spnav_axis(std::int32_t value, int sign) { return sign * std::clamp<std::int32_t>(value, -kFullDeflection, kFullDeflection); }

}  // namespace

bool SpnavEvents::apply(SpaceMouseState& state) const {
  std::array<std::int32_t, 8> values{};
  static_assert(sizeof values == kSpnavEventBytes);
  std::memcpy(values.data(), event_.data(), sizeof values);  // the daemon runs on the same machine: its byte order is ours
  switch (values[0]) {
    case kSpnavMotion:
      // x stays, y and z are swapped and turned round: spacenavd's default mapping, undone.
      state.shift = {spnav_axis(values[1], 1), spnav_axis(values[3], -1), spnav_axis(values[2], -1)};
      state.turn = {spnav_axis(values[4], 1), spnav_axis(values[6], -1), spnav_axis(values[5], -1)};
      return true;
    case kSpnavPress:
    case kSpnavRelease: {
      if (values[1] < 0 || values[1] > 63) return false;
      const std::uint64_t button = std::uint64_t{1} << values[1];
      state.buttons = values[0] == kSpnavPress ? state.buttons | button : state.buttons & ~button;
      return true;
    }
    default: return false;
  }
}

std::string spnav_socket_path() {
  const char* named = std::getenv("SPNAV_SOCKET");
  return named != nullptr && *named != 0 ? named : "/var/run/spnav.sock";
}

Result<std::unique_ptr<port::HidPort>> connect_to_spnav(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return fail(Error{path, 0, "the path of spacenavd's socket is too long"});
  std::copy(path.begin(), path.end(), address.sun_path);
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return fail(Error{path, 0, std::string("no socket for spacenavd: ") + std::strerror(errno)});
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const int error = errno;
    ::close(descriptor);
    return fail(Error{path, 0, std::string("spacenavd can't be reached: ") + std::strerror(error)});
  }
  return port::hid_port_of(descriptor);
}

}  // namespace prismesh::drivers::space_mouse
