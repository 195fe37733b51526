// Tells systemd how the daemon is: ready, alive, ending. Without systemd these do nothing.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "ipc/wire/descriptor.h"

namespace prismesh::daemon {

/// Clients can connect. `status`: a line for people who ask systemd.
void tell_ready(const std::string& status);
void tell_ending();
/// The daemon works: call it at least every `supervised_period`.
void tell_alive();

/// Half the time after which systemd takes the daemon for hung; nothing: it doesn't watch it.
std::optional<std::chrono::microseconds> supervised_period();

/// The socket that systemd listens at for this daemon at `path`; nothing: it has made none.
std::optional<ipc::Descriptor> inherited_socket(const std::filesystem::path& path);

}  // namespace prismesh::daemon
