#include "kiosk/tools/contact/contact_link.h"

#include <utility>
#include <variant>

#include "ipc/wire/failure.h"
#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::tools::contact {

void ContactLink::want(std::uint64_t generation, bool now) {
  if (asking_ && asked_on_ != link_.connection.number()) asking_ = false;
  if (asking_ || !link_.connection.connected()) return;
  const bool here = contacts_ && contacts_->generation == generation;
  if (!now && (here || refused_ == generation || took_ns_ > kMaxOwnSearchNs)) return;
  asking_ = true;
  asked_on_ = link_.connection.number();
  const std::int64_t asked_ns = clock_.now_ns();
  link_.connection.question(ipc::GetContacts{}, [this, generation, asked_ns, question = ++question_](const ipc::Answer& answer) {
    if (question != question_) return;
    asking_ = false;
    ++answers_;
    took_ns_ = clock_.now_ns() - asked_ns;
    refused_.reset();
    problem_.clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      refused_ = generation;
      problem_ = link::was_stopped(*failed) ? "stopped; look again to see it" : ipc::error_from(*failed).text();
    }
    if (const auto* contacts = std::get_if<ipc::Contacts>(&answer)) contacts_ = *contacts;
  });
}

void ContactLink::forget() {
  contacts_.reset();
  refused_.reset();
  problem_.clear();
  took_ns_ = 0;
  asking_ = false;
  ++question_;
}

}  // namespace prismesh::kiosk::tools::contact
