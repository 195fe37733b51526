// Where the daemons' sockets and journals are.
#pragma once

#include <filesystem>
#include <optional>

namespace prismesh::ipc {

/// The folder for sockets: `override`, else $RUNTIME_DIRECTORY, else $XDG_RUNTIME_DIR/prismesh, else a per-user folder in /tmp.
std::filesystem::path runtime_directory(const std::optional<std::filesystem::path>& override = {});

/// The folder for journals: `override`, else $STATE_DIRECTORY, else $XDG_STATE_HOME/prismesh, else ~/.local/state/prismesh.
std::filesystem::path state_directory(const std::optional<std::filesystem::path>& override = {});

}  // namespace prismesh::ipc
