#include "ipc/intake/roles.h"

#include <variant>

namespace prismesh::ipc {

namespace {

Role role_of(const IntakeHello&) { return Role::watch; }
Role role_of(const GetIntake&) { return Role::watch; }
// Whoever may change the document may let others in.
Role role_of(const MakePairingCode&) { return Role::edit; }
Role role_of(const GetTokens&) { return Role::edit; }
Role role_of(const RevokeToken&) { return Role::edit; }
Role role_of(const PublishWork&) { return Role::offer; }
Role role_of(const DescribeModel&) { return Role::offer; }

}  // namespace

Role role_for(const IntakeRequest& request) {
  return std::visit([](const auto& each) { return role_of(each); }, request);
}

}  // namespace prismesh::ipc
