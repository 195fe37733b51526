// Shows the progress of long work: a bar on a terminal, else lines for work that says what it is doing.
#pragma once

#include <cstdint>
#include <string>

#include "base/clock.h"
#include "base/progress.h"
#include "cli/context.h"

namespace prismesh::cli {

/// Writes to `context.err`. If that is a terminal, it draws a bar there after 0.3 s of work, and at most ten times a second; the destructor
/// erases it. If not, work that has words gets a line after 2 s, and then one every 5 s; other work is silent.
class ProgressBar {
 public:
  ProgressBar(const Context& context, std::string what, Clock& clock);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// The progress function for the work: it tells the work to stop when the user wants that. Must not outlive the bar.
  Progress progress();

 private:
  void draw(double fraction, const Doing& doing);
  void write_line(const Doing& doing);
  /// The words and the seconds since the beginning.
  std::string said(const Doing& doing) const;

  const Context& context_;
  std::string what_;
  Clock& clock_;
  std::int64_t begun_ns_;
  std::int64_t next_draw_ns_;
  bool drawn_ = false;
};

}  // namespace prismesh::cli
