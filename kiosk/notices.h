// The sentences that wait to be read by the user.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "kiosk/panels/panels.h"
#include "kiosk/trace.h"

namespace prismesh::kiosk {

class Notices {
 public:
  explicit Notices(Trace trace) : trace_(trace) {}

  /// Says it in the trace too.
  void say(panels::Notice::Kind kind, std::string text);
  /// Information gives way to anything newer; errors and warnings stay until they are read.
  void take(panels::Notice notice);

  bool empty() const { return waiting_.empty(); }
  /// The one to be read next.
  const panels::Notice& front() const { return waiting_.front(); }
  std::size_t count() const { return waiting_.size(); }
  void read() { waiting_.pop_front(); }

 private:
  Trace trace_;
  std::deque<panels::Notice> waiting_;
};

/// The line of a trace that tells a notice.
std::string trace_of(const panels::Notice& notice);

}  // namespace prismesh::kiosk
