#include "base/parallel_for.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace prismesh {

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  if (count <= grain) {
    if (count > 0) body(0, count);
    return;
  }
  const std::size_t ranges = (count + grain - 1) / grain;
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t range) { body(range * grain, std::min(count, (range + 1) * grain)); });
}

}  // namespace prismesh
