// The command line as a function, so that tests can call it.
#pragma once

#include <atomic>
#include <iosfwd>
#include <span>
#include <string>

namespace prismesh::cli {

/// Exit statuses that scripts rely on.
inline constexpr int kDone = 0;        ///< done, warnings allowed
inline constexpr int kFailed = 1;      ///< the deck or an edit could not be done as asked
inline constexpr int kWrongUsage = 2;  ///< wrong arguments, unparsable JSON

/// Where a command runs: its output, and who may stop it.
struct Surroundings {
  std::ostream& out;                               ///< results: text, or JSON alone with --json
  std::ostream& err;                               ///< reasons, warnings and the progress bar
  bool terminal = false;                           ///< `err` is a terminal: long work shows a bar
  const std::atomic<bool>* interrupted = nullptr;  ///< true: stop, leave nothing

  bool stop() const { return interrupted != nullptr && interrupted->load(std::memory_order_relaxed); }
};

/// Runs `prismesh ARGS..`; `args` without the program's name. Returns the exit status.
int run(std::span<const std::string> args, const Surroundings& surroundings);
int run(std::span<const std::string> args, std::ostream& out, std::ostream& err);

}  // namespace prismesh::cli
