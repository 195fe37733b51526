// The sockets that systemd makes for daemons before it starts them.
#pragma once

#include <filesystem>
#include <optional>

#include "ipc/wire/descriptor.h"

namespace prismesh::daemon {

/// The socket that systemd listens at for this daemon at `path`; nothing: it has made none.
std::optional<ipc::Descriptor> inherited_socket(const std::filesystem::path& path);

}  // namespace prismesh::daemon
