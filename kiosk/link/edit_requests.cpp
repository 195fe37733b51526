#include "kiosk/link/edit_requests.h"

#include <utility>
#include <variant>

#include "kiosk/link/notice_words.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::kiosk::link {

bool is_selecting(std::string_view edit) {
  const mesh::document::EditKind* kind = mesh::document::find_edit_kind(edit);
  return kind != nullptr && kind->group == mesh::document::EditGroup::selection;
}

EditRequests::EditRequests(Connection& connection, FollowedDocument& document, LinkNotices& notices)
    : connection_(connection), document_(document), notices_(notices) {
  connection_.add(*this);
}

void EditRequests::send(mesh::document::Edit edit) {
  const bool selecting = is_selecting(mesh::document::name(edit));
  if (connection_.connected()) ++under_way_;
  connection_.ask(ipc::ApplyEdit{std::move(edit)}, [this, selecting](const ipc::Answer& answer) {
    --under_way_;
    connection_.progress().clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) notices_.say(notice_of_failure(*failed, "the model is as it was"));
    const auto* edited = std::get_if<ipc::Edited>(&answer);
    if (edited == nullptr) return;
    if (!document_.shows(edited->generation)) document_.outdate();
    if (selecting) return;  // what a selection did is in the picture
    if (auto notice = notice_of_report(edited->report)) notices_.say(std::move(*notice));
  });
}

}  // namespace prismesh::kiosk::link
