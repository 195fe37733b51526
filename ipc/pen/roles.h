// The role that each request to the pen's process needs.
#pragma once

#include "ipc/pen/messages.h"
#include "ipc/wire/roles.h"

namespace prismesh::ipc {

/// A new request needs an entry here: without one this doesn't compile.
Role role_for(const PenRequest& request);

}  // namespace prismesh::ipc
