#include "base/parallel_for.h"

#include <algorithm>

#ifdef PRISMESH_THREAD_SANITIZER
#include <atomic>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#endif

namespace prismesh {
namespace {

#ifdef PRISMESH_THREAD_SANITIZER
/// Debian's TBB isn't built for ThreadSanitizer, which then reports TBB itself. Plain threads let it see the bodies' own races.
void for_each_range(std::size_t ranges, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t range = next++; range < ranges; range = next++) body(range);
  };
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < 3; ++thread) threads.emplace_back(work);
  work();
}
#else
void for_each_range(std::size_t ranges, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t range) { body(range); });
}
#endif

}  // namespace

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  if (count <= grain) {
    if (count > 0) body(0, count);
    return;
  }
  const std::size_t ranges = (count + grain - 1) / grain;
  for_each_range(ranges, [&](std::size_t range) { body(range * grain, std::min(count, (range + 1) * grain)); });
}

}  // namespace prismesh
