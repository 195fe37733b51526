// Shows a progress bar on the terminal during long work.
#pragma once

#include <cstdint>
#include <string>

#include "base/clock.h"
#include "base/progress.h"
#include "cli/context.h"

namespace prismesh::cli {

/// Draws on `context.err` if that is a terminal: after 0.3 s of work, and at most ten times a second. The destructor erases the bar.
class ProgressBar {
 public:
  ProgressBar(const Context& context, std::string what, Clock& clock);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// The progress function for the work: it tells the work to stop when the user wants that. Must not outlive the bar.
  Progress progress();

 private:
  void draw(double fraction);

  const Context& context_;
  std::string what_;
  Clock& clock_;
  std::int64_t next_draw_ns_;
  bool drawn_ = false;
};

}  // namespace prismesh::cli
