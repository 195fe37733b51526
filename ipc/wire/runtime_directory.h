// Where the daemons' sockets are.
#pragma once

#include <filesystem>
#include <optional>

namespace prismesh::ipc {

/// The folder for sockets: `override`, else $RUNTIME_DIRECTORY, else $XDG_RUNTIME_DIR/prismesh, else a per-user folder in /tmp.
std::filesystem::path runtime_directory(const std::optional<std::filesystem::path>& override = {});

}  // namespace prismesh::ipc
