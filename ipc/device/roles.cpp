#include "ipc/device/roles.h"

#include <variant>

namespace prismesh::ipc {

namespace {

Role needed(const DeviceHello&) { return Role::watch; }
Role needed(const GetDevices&) { return Role::watch; }
// Depth is shown or not by what the loop is told.
Role needed(const PictureShown&) { return Role::devices; }
Role needed(const HoldMask&) { return Role::devices; }
Role needed(const ReleaseMask&) { return Role::devices; }
Role needed(const Rearm&) { return Role::devices; }
Role needed(const Reload&) { return Role::devices; }

}  // namespace

Role role_for(const DeviceRequest& request) {
  return std::visit([](const auto& each) { return needed(each); }, request);
}

}  // namespace prismesh::ipc
