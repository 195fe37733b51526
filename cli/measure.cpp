#include "cli/measure.h"

#include <algorithm>
#include <vector>

namespace prismesh::cli {

namespace {

/// `times` has at least one entry.
double median_ms(std::vector<std::int64_t> times_ns) {
  std::sort(times_ns.begin(), times_ns.end());
  const std::size_t upper = times_ns.size() / 2, lower = (times_ns.size() - 1) / 2;
  return static_cast<double>(times_ns[lower] + times_ns[upper]) * 0.5e-6;
}

}  // namespace

Result<Timing> measure(const TimedWork& work, const Stopwatches& stopwatches, const RepetitionLimits& limits) {
  std::vector<std::int64_t> wall_ns, cpu_ns;
  std::int64_t total_ns = 0;
  const auto goes_on = [&] {
    const std::size_t runs = wall_ns.size();
    if (runs == 0) return true;
    return runs < limits.max_runs && total_ns < (runs < limits.min_runs ? limits.too_much_ns : limits.enough_ns);
  };
  while (goes_on()) {
    if (work.prepare) work.prepare();
    const std::int64_t wall_start_ns = stopwatches.wall.now_ns(), cpu_start_ns = stopwatches.cpu.now_ns();
    if (Result<void> done = work.run(); !done) return fail(std::move(done.error()));
    cpu_ns.push_back(stopwatches.cpu.now_ns() - cpu_start_ns);
    wall_ns.push_back(stopwatches.wall.now_ns() - wall_start_ns);
    total_ns += std::max(wall_ns.back(), cpu_ns.back());
  }
  return Timing{wall_ns.size(), median_ms(wall_ns), static_cast<double>(*std::min_element(wall_ns.begin(), wall_ns.end())) * 1e-6,
                median_ms(cpu_ns)};
}

}  // namespace prismesh::cli
