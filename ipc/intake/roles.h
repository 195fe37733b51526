// The role that each request to prismesh-intake needs.
#pragma once

#include "ipc/intake/messages.h"
#include "ipc/wire/roles.h"

namespace prismesh::ipc {

/// A new request needs an entry here: without one this doesn't compile.
Role role_for(const IntakeRequest& request);

}  // namespace prismesh::ipc
