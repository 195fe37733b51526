// How long a piece of work took, and what measuring it needs. Inner to cli.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "base/clock.h"
#include "base/error.h"

namespace prismesh::cli {

/// The two times that are read around each repetition.
struct Stopwatches {
  Clock& wall;
  Clock& cpu;  ///< processor time of all threads of this process
};

/// Work to be measured.
struct TimedWork {
  std::function<void()> prepare;      ///< before each repetition, outside the measured time; may be empty
  std::function<Result<void>()> run;  ///< the measured part; must do the same work each time
};

/// When to stop repeating.
struct RepetitionLimits {
  std::size_t min_runs = 3;
  std::size_t max_runs = 100;
  std::int64_t enough_ns = 500'000'000;      ///< of wall or processor time in all runs: no run more than min_runs is begun
  std::int64_t too_much_ns = 3'000'000'000;  ///< of either: no run more is begun, even below min_runs
};

struct Timing {
  std::size_t runs = 0;
  double median_ms = 0;  ///< wall time
  double min_ms = 0;     ///< wall time
  double cpu_ms = 0;     ///< median of the processor time
};

}  // namespace prismesh::cli
