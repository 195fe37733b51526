#include "daemon/common/inherited_socket.h"

#include <sys/socket.h>
#include <systemd/sd-daemon.h>

namespace prismesh::daemon {

std::optional<ipc::Descriptor> inherited_socket(const std::filesystem::path& path) {
  const int count = ::sd_listen_fds(0);
  for (int socket = SD_LISTEN_FDS_START; socket < SD_LISTEN_FDS_START + count; ++socket)
    if (::sd_is_socket_unix(socket, SOCK_STREAM, 1, path.c_str(), 0) > 0) return ipc::Descriptor(socket);
  return std::nullopt;
}

}  // namespace prismesh::daemon
