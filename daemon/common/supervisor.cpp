#include "daemon/common/supervisor.h"

#include <sys/socket.h>
#include <systemd/sd-daemon.h>

namespace prismesh::daemon {

void tell_ready(const std::string& status) { (void)::sd_notify(0, ("READY=1\nSTATUS=" + status).c_str()); }
void tell_ending() { (void)::sd_notify(0, "STOPPING=1"); }
void tell_alive() { (void)::sd_notify(0, "WATCHDOG=1"); }

std::optional<std::chrono::microseconds> supervised_period() {
  std::uint64_t period_us = 0;
  if (::sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
  return std::chrono::microseconds(period_us / 2);
}

std::optional<ipc::Descriptor> inherited_socket(const std::filesystem::path& path) {
  const int count = ::sd_listen_fds(0);
  for (int socket = SD_LISTEN_FDS_START; socket < SD_LISTEN_FDS_START + count; ++socket)
    if (::sd_is_socket_unix(socket, SOCK_STREAM, 1, path.c_str(), 0) > 0) return ipc::Descriptor(socket);
  return std::nullopt;
}

}  // namespace prismesh::daemon
