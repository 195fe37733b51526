// Keeps the notices that the user hasn't read yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "kiosk/notices/notice.h"
#include "kiosk/notices/trace.h"

namespace prismesh::kiosk::notices {

class Notices {
 public:
  explicit Notices(Trace trace) : trace_(trace) {}

  /// Adds a notice about the open document, and writes it to the trace.
  void say(Notice::Kind kind, std::string text);
  /// Adds a notice: errors before warnings before information. A newer notice replaces information. Drops notices about a document that is
  /// closed.
  void take(Notice notice);
  /// Another document is open: drops notices about those before.
  void follow(std::uint64_t document_number);

  bool empty() const { return waiting_.empty(); }
  /// The next one to read.
  const Notice& front() const { return waiting_.front(); }
  std::size_t count() const { return waiting_.size(); }
  void read() { waiting_.pop_front(); }
  /// Drops the notice about the deck's warnings, as the user reads their list.
  void read_warnings();

 private:
  Trace trace_;
  std::uint64_t document_ = 0;
  std::deque<Notice> waiting_;
};

/// The trace line of a notice.
std::string trace_of(const Notice& notice);

}  // namespace prismesh::kiosk::notices
