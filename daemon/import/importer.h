// Answers the one request of a connection: reads a deck, locked in, and hands it over.
#pragma once

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::importer {

/// Errors: no request came, or the answer can't be sent. Everything else is told in the answer. Afterwards the process is locked in.
Result<void> serve(ipc::Descriptor socket);

}  // namespace prismesh::importer
