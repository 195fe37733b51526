#include "kiosk/tools/welding/weld_list.h"

#include <variant>

#include "ipc/wire/failure.h"

namespace prismesh::kiosk::tools::welding {

void WeldList::want(std::uint64_t generation, bool now) {
  if (asking_ && asked_on_ != link_.connection.number()) asking_ = false;
  if (asking_ || !link_.connection.connected()) return;
  const bool here = checks_ && checks_->generation == generation;
  const bool slow = checks_ && checks_->search_ns > kMaxOwnWeldSearchNs;
  if (!now && (here || slow || refused_ == generation)) return;
  asking_ = true;
  asked_on_ = link_.connection.number();
  link_.connection.question(ipc::GetWeldChecks{}, [this, generation, question = ++question_](const ipc::Answer& answer) {
    if (question != question_) return;
    asking_ = false;
    ++answers_;
    refused_.reset();
    problem_.clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      refused_ = generation;
      problem_ = ipc::error_from(*failed).text();
    }
    if (const auto* checks = std::get_if<ipc::WeldChecks>(&answer)) checks_ = *checks;
  });
}

void WeldList::forget() {
  checks_.reset();
  refused_.reset();
  problem_.clear();
  asking_ = false;
  ++question_;
}

}  // namespace prismesh::kiosk::tools::welding
