#include "kiosk/link/edit_requests.h"

#include <utility>
#include <variant>

#include "kiosk/link/notice_words.h"
#include "kiosk/link/result_words.h"
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
  std::string what = words_of_edit(edit, document_.length_unit());
  if (connection_.connected()) ++under_way_;
  connection_.ask(ipc::ApplyEdit{std::move(edit)},
                  [this, selecting, what = std::move(what)](const ipc::Answer& answer) { answered(answer, selecting, what); });
}

void EditRequests::go_to(std::uint64_t generation) {
  if (connection_.connected()) ++under_way_;
  connection_.ask(ipc::GoTo{generation}, [this](const ipc::Answer& answer) { answered(answer, false, {}); });
}

void EditRequests::answered(const ipc::Answer& answer, bool selecting, const std::string& what) {
  --under_way_;
  connection_.progress().clear();
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) notices_.say(notice_of_failure(*failed, "the model is as it was"));
  const auto* edited = std::get_if<ipc::Edited>(&answer);
  if (edited == nullptr) return;
  if (!document_.shows(edited->generation)) document_.outdate();
  if (selecting) return;  // what a selection did is in the picture
  notices_.tell_edit(what, edited->report, document_.length_unit(), edited->generation);
}

}  // namespace prismesh::kiosk::link
