// Asks prismesh-setup one thing.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::ipc {

/// The socket in the runtime folder on which systemd starts prismesh-setup.
std::filesystem::path setup_socket_path(const std::optional<std::filesystem::path>& override = {});

/// Connects, sends and waits for the answer. Errors: nobody listens, or may be asked; no answer in time; Failed, as the Error that it
/// tells: its file is the field that is wrong.
Result<SetupAnswer> ask_setup(const std::filesystem::path& socket, const SetupRequest& request,
                              std::chrono::milliseconds patience = std::chrono::seconds(20));

}  // namespace prismesh::ipc
