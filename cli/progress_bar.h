// A bar on the terminal for work that takes a while.
#pragma once

#include <cstdint>
#include <string>

#include "base/clock.h"
#include "base/progress.h"
#include "cli/context.h"

namespace prismesh::cli {

/// Draws on `context.err` if that is a terminal, not before the work has taken 0.3 s, and at most ten times a second.
/// Goes away without a trace when it dies.
class ProgressBar {
 public:
  ProgressBar(const Context& context, std::string what, Clock& clock);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// To hand to the work; it stops the work when the user asks for it. Must not outlive the bar.
  Progress progress();

 private:
  void draw(double fraction);

  const Context& surroundings_;
  std::string what_;
  Clock& clock_;
  std::int64_t next_draw_ns_;
  bool drawn_ = false;
};

}  // namespace prismesh::cli
