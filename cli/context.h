// Data for every command: output streams, the stop flag and the exit statuses.
#pragma once

#include <atomic>
#include <iosfwd>

#include "base/clock.h"

namespace prismesh::cli {

/// Exit statuses that scripts rely on.
inline constexpr int kDone = 0;        ///< done, warnings allowed
inline constexpr int kFailed = 1;      ///< the deck or an edit could not be done as asked
inline constexpr int kWrongUsage = 2;  ///< wrong arguments, unparsable JSON

/// The streams that a command writes to, the flag that stops it, and its clock.
struct Context {
  std::ostream& out;                               ///< results: text, or JSON alone with --json
  std::ostream& err;                               ///< reasons, warnings and the progress bar
  bool terminal = false;                           ///< `err` is a terminal: long work shows a bar; else a repair writes lines
  const std::atomic<bool>* interrupted = nullptr;  ///< true: stop, and leave no files but of a repair that is to be kept
  Clock* clock = nullptr;                          ///< measures long edits; null: the machine's

  bool stop() const { return interrupted != nullptr && interrupted->load(std::memory_order_relaxed); }
};

}  // namespace prismesh::cli
