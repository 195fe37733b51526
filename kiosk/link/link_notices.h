// Keeps what the link has to tell the user until it is taken.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kiosk/link/document_number.h"
#include "kiosk/notices/notices.h"

namespace prismesh::kiosk::link {

class LinkNotices {
 public:
  LinkNotices(const DocumentNumber& number, notices::Trace trace) : number_(number), trace_(trace) {}

  /// Adds a notice about the document that is open, and writes it to the trace.
  void say(notices::Notice notice) {
    ++changes_;
    notice.document = number_.value();
    trace_.line(notices::trace_of(notice));
    waiting_.push_back(std::move(notice));
  }
  std::vector<notices::Notice> take() { return std::exchange(waiting_, {}); }
  /// Counts up with each notice.
  std::uint64_t changes() const { return changes_; }

 private:
  const DocumentNumber& number_;
  notices::Trace trace_;
  std::vector<notices::Notice> waiting_;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::kiosk::link
