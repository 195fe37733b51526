#include "ipc/model/roles.h"

#include <variant>

namespace prismesh::ipc {

namespace {

// What only reads the current document.
Role needed(const Hello&) { return Role::watch; }
Role needed(const Count&) { return Role::watch; }
Role needed(const GetQuality&) { return Role::watch; }
Role needed(const FindShells&) { return Role::watch; }
Role needed(const GetState&) { return Role::watch; }
Role needed(const GetHistory&) { return Role::watch; }
Role needed(const GetSnapshot&) { return Role::watch; }
Role needed(const ReturnSnapshot&) { return Role::watch; }
// Another deck is read with the daemon's rights, from any path.
Role needed(const GetField& wanted) { return wanted.against == "opened" || wanted.against == "surface" ? Role::watch : Role::edit; }

Role needed(const Open&) { return Role::edit; }
Role needed(const Save&) { return Role::edit; }
Role needed(const Close&) { return Role::edit; }
Role needed(const ApplyEdit&) { return Role::edit; }
Role needed(const GoTo&) { return Role::edit; }
Role needed(const BeginDrag&) { return Role::edit; }
Role needed(const DragStep&) { return Role::edit; }
Role needed(const CommitDrag&) { return Role::edit; }
Role needed(const CancelDrag&) { return Role::edit; }
Role needed(const Cancel&) { return Role::edit; }
// These change nothing, but may keep the worker for as long as an edit.
Role needed(const PreviewEdit&) { return Role::edit; }
Role needed(const FindFollowedEdges&) { return Role::edit; }
Role needed(const GetContacts&) { return Role::edit; }
Role needed(const GetWeldChecks&) { return Role::edit; }
// This turns the pictures of others.
Role needed(const ShareCamera&) { return Role::edit; }
// Whoever hands the field on to the pen's process needs this role there. The document stays as it is.
Role needed(const FollowPen&) { return Role::devices; }
Role needed(const LeavePen&) { return Role::devices; }

}  // namespace

Role role_for(const Request& request) {
  return std::visit([](const auto& each) { return needed(each); }, request);
}

}  // namespace prismesh::ipc
