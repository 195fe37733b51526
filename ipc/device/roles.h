// The role that each of deviced's requests needs.
#pragma once

#include "ipc/device/messages.h"
#include "ipc/wire/roles.h"

namespace prismesh::ipc {

/// A new request needs an entry here: without one this doesn't compile.
Role role_for(const DeviceRequest& request);

}  // namespace prismesh::ipc
