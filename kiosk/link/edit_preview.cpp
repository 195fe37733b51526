#include "kiosk/link/edit_preview.h"

namespace prismesh::kiosk::link {

void EditPreview::ask(const mesh::document::Edit& edit) {
  previewed_.reset();
  connection_.question(ipc::PreviewEdit{edit}, [this, number = ++number_](const ipc::Answer& answer) {
    if (number != number_) return;
    Previewed& previewed = previewed_.emplace();
    previewed.number = number;
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) previewed.problem = failed->message;
    if (const auto* would = std::get_if<ipc::EditPreviewed>(&answer)) previewed.would = *would;
  });
}

void EditPreview::forget() {
  ++number_;
  previewed_.reset();
}

}  // namespace prismesh::kiosk::link
