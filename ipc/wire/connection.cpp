#include "ipc/wire/connection.h"

#include <cerrno>
#include <cstring>

namespace prismesh::ipc {

Result<bool> wait_for_socket(int socket, short what, std::chrono::steady_clock::time_point until) {
  using Time = std::chrono::steady_clock;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Time::now()).count();
    pollfd ready{socket, what, 0};
    const int status = ::poll(&ready, 1, static_cast<int>(std::clamp<long long>(left, 0, 1'000'000)));
    if (status > 0) return true;
    if (status == 0 && Time::now() >= until) return false;
    if (status < 0 && errno != EINTR) return fail("", std::string("poll: ") + std::strerror(errno));
  }
}

}  // namespace prismesh::ipc
