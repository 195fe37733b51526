#include "kiosk/tools/quality/quality_link.h"

#include <utility>

namespace prismesh::kiosk::tools::quality {

void QualityLink::want(const Wish& wish, std::uint64_t generation) {
  if (asking_ && asked_on_ != link_.connection.number()) asking_ = false;
  if (asking_ || !link_.connection.connected() || up_to_date(wish, generation) || refused_ == std::pair(wish, generation)) return;
  asking_ = true;
  asked_on_ = link_.connection.number();
  link_.connection.question(ipc::GetQuality{wish.metric, wish.damaged}, [this, wish, generation](const ipc::Answer& answer) {
    asking_ = false;
    refused_.reset();
    if (std::holds_alternative<ipc::Failed>(answer)) refused_.emplace(wish, generation);
    if (const auto* quality = std::get_if<ipc::Quality>(&answer)) {
      figures_ = *quality;
      figures_of_ = wish;
    }
  });
}

void QualityLink::select(const ipc::QualityBar& bar, const Wish& wish, mesh::document::SelectMode mode) {
  ipc::FindShells find;
  find.metric = wish.metric;
  find.damaged = wish.damaged;
  if (!bar.open_below) find.from = bar.from;
  if (!bar.open_above) find.to = bar.to;
  link_.connection.question(find, [this, mode](const ipc::Answer& answer) {
    const auto* found = std::get_if<ipc::ShellsFound>(&answer);
    if (found == nullptr || found->expr.empty()) return;
    mesh::document::Select edit;
    edit.expr = found->expr;
    edit.kind = mesh::select::EntityKind::element;
    edit.mode = mode;
    send_(std::move(edit));
  });
}

}  // namespace prismesh::kiosk::tools::quality
