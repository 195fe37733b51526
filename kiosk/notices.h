// The sentences that wait to be read by the user.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "kiosk/panels/panel_facts.h"
#include "kiosk/trace.h"

namespace prismesh::kiosk {

class Notices {
 public:
  explicit Notices(Trace trace) : trace_(trace) {}

  /// Of the document that is open. Says it in the trace too.
  void say(panels::Notice::Kind kind, std::string text);
  /// Errors stand before warnings, these before information, which gives way to anything newer. What speaks of a document that isn't
  /// open any more is left out.
  void take(panels::Notice notice);
  /// Another document is open: what was said of those before goes.
  void follow(std::uint64_t document_number);

  bool empty() const { return waiting_.empty(); }
  /// The one to be read next.
  const panels::Notice& front() const { return waiting_.front(); }
  std::size_t count() const { return waiting_.size(); }
  void read() { waiting_.pop_front(); }
  /// The deck's warnings are read in their list.
  void read_warnings();

 private:
  Trace trace_;
  std::uint64_t document_ = 0;
  std::deque<panels::Notice> waiting_;
};

/// The line of a trace that tells a notice.
std::string trace_of(const panels::Notice& notice);

}  // namespace prismesh::kiosk
