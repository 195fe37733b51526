// The role that each of modeld's requests needs.
#pragma once

#include "ipc/model/messages.h"
#include "ipc/wire/roles.h"

namespace prismesh::ipc {

/// A new request needs an entry here: without one this doesn't compile.
Role role_for(const Request& request);

}  // namespace prismesh::ipc
