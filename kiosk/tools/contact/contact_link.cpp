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
  if (!now && (here || refused_ == generation || slow_)) return;
  asking_ = true;
  asked_on_ = link_.connection.number();
  link_.connection.question(ipc::GetContacts{}, [this, generation, question = ++question_](const ipc::Answer& answer) {
    if (question != question_) return;
    asking_ = false;
    ++answers_;
    refused_.reset();
    problem_.clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      refused_ = generation;
      const bool stopped = link::was_stopped(*failed);
      if (stopped) slow_ = true;
      problem_ = stopped ? "stopped; look again to see it" : ipc::error_from(*failed).text();
    }
    if (const auto* contacts = std::get_if<ipc::Contacts>(&answer)) {
      contacts_ = *contacts;
      slow_ = contacts->search_ns > kMaxOwnSearchNs;
    }
  });
}

void ContactLink::forget() {
  contacts_.reset();
  refused_.reset();
  problem_.clear();
  slow_ = false;
  asking_ = false;
  ++question_;
}

}  // namespace prismesh::kiosk::tools::contact
