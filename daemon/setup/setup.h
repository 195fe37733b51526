// The root's side of a station's set-up: reads one request of the kiosk, checks it, writes what it sets, and answers.
#pragma once

#include "base/error.h"
#include "daemon/setup/station_files.h"
#include "ipc/setup/messages.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::setup {

/// Does what a request says, which must have passed ipc::check_setup. The running machine follows where the files are its own.
ipc::SetupAnswer carry_out(const ipc::SetupRequest& request, const StationFiles& files);

/// Serves one connection: root, the program's own user and `kiosk` may ask (the last by name; empty: nobody else). Errors: what was wrong
/// with the connection; whoever asked got an answer where that was possible.
Result<void> serve(ipc::Descriptor connection, const StationFiles& files, const std::string& kiosk);

}  // namespace prismesh::setup
