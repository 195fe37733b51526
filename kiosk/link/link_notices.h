// Keeps what the link has to tell the user until it is taken, and what the last edit did.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kiosk/link/document_number.h"
#include "kiosk/notices/notices.h"
#include "mesh/document/edit_report.h"

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
  /// Tells what an edit did: its result in a line (may be empty), and its notes. `generation`: that it made.
  void tell_edit(const std::string& what, const mesh::document::EditReport& report, std::string_view unit, std::uint64_t generation);
  /// A state is shown. If it comes before the one that the result is of, somebody undid the edit: its result is forgotten.
  void follow_state(std::uint64_t generation, bool can_redo) {
    if (can_redo && generation != result_generation_) forget_result();
  }
  /// Of the last edit that has one; empty: forgotten, or the deck is another.
  const std::string& result() const;
  /// Counts up with each result.
  std::uint64_t results() const { return results_; }
  void forget_result() { result_.clear(); }
  std::vector<notices::Notice> take() { return std::exchange(waiting_, {}); }
  /// Counts up with each notice.
  std::uint64_t changes() const { return changes_; }

 private:
  const DocumentNumber& number_;
  notices::Trace trace_;
  std::vector<notices::Notice> waiting_;
  std::uint64_t changes_ = 0;
  std::string result_;
  std::uint64_t result_of_ = 0;          ///< the document that it is about
  std::uint64_t result_generation_ = 0;  ///< of the state that its edit made
  std::uint64_t results_ = 0;
};

}  // namespace prismesh::kiosk::link
