#include "kiosk/tools/selection/outline.h"

namespace prismesh::kiosk::tools::selection {

using input::Pixel;

std::vector<Pixel> kept_right_of(const std::vector<Pixel>& outline, double min_x) {
  std::vector<Pixel> kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Pixel &from = outline[i], &to = outline[(i + 1) % outline.size()];
    const bool from_kept = from.x() >= min_x, to_kept = to.x() >= min_x;
    if (from_kept) kept.push_back(from);
    if (from_kept != to_kept) kept.push_back(from + (min_x - from.x()) / (to.x() - from.x()) * (to - from));
  }
  return kept;
}

}  // namespace prismesh::kiosk::tools::selection
