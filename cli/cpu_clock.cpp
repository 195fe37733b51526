#include "cli/cpu_clock.h"

#include <ctime>

namespace prismesh::cli {

std::int64_t ProcessCpuClock::now_ns() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<std::int64_t>(used.tv_sec) * 1'000'000'000 + used.tv_nsec;
}

}  // namespace prismesh::cli
