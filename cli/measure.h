// Measures a piece of work by repeating it. Inner to cli.
#pragma once

#include "cli/timing.h"

namespace prismesh::cli {

/// Runs the work until a limit is reached, and returns the median and the minimum of its times. Of an even number of runs the median is
/// the mean of the two in the middle. Errors: the first that the work returns; nothing is measured then.
Result<Timing> measure(const TimedWork& work, const Stopwatches& stopwatches, const RepetitionLimits& limits = {});

}  // namespace prismesh::cli
