#include "ipc/pen/roles.h"

#include <variant>

namespace prismesh::ipc {

namespace {

Role role_of(const PenHello&) { return Role::watch; }
Role role_of(const GetPen&) { return Role::watch; }
// What moves a hand.
Role role_of(const ArmPen&) { return Role::devices; }
Role role_of(const DisarmPen&) { return Role::devices; }
Role role_of(const SetFeel&) { return Role::devices; }
Role role_of(const AttachField&) { return Role::devices; }

}  // namespace

Role role_for(const PenRequest& request) {
  return std::visit([](const auto& each) { return role_of(each); }, request);
}

}  // namespace prismesh::ipc
