// Answers the one request of a connection, locked in: reads a deck and hands it over, or the new text that edits of it need.
#pragma once

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::importer {

/// Errors: no request came, or the answer can't be sent. Everything else is told in the answer. Afterwards the process is locked in.
Result<void> serve(ipc::Descriptor socket);

}  // namespace prismesh::importer
