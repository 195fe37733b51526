// Counts crossings of a horizontal ray with the outline's edges, which are sorted into bands of height: a node is tested against few edges.
#include "mesh/select/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/parallel_for.h"
#include "mesh/select/projection.h"

namespace prismesh::mesh::select {

namespace {

/// An edge of the outline from low to high; it crosses the heights low_y <= y < high_y.
struct OutlineEdge {
  double low_x = 0;
  double low_y = 0;
  double high_y = 0;
  double width = 0;   ///< high_x - low_x
  double height = 0;  ///< high_y - low_y, > 0
  int sense = 0;      ///< +1 drawn upwards, -1 downwards

  /// Whether a point at one of its heights lies to its left. Without a division, so that no rounding of a quotient decides.
  bool is_right_of(double x, double y) const { return (x - low_x) * height < (y - low_y) * width; }
};

/// A point is inside if its winding number isn't 0: a lasso that crosses itself also contains what it encircles twice.
class Outline {
 public:
  explicit Outline(const std::vector<std::array<double, 2>>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) add(points[i], points[(i + 1) % points.size()]);
    if (edges_.empty()) return;
    for (const auto& point : points) {
      low_y_ = std::min(low_y_, point[1]);
      high_y_ = std::max(high_y_, point[1]);
      low_x_ = std::min(low_x_, point[0]);
      high_x_ = std::max(high_x_, point[0]);
    }
    fill_bands();
  }

  bool contains(double x, double y) const {
    if (!(y >= low_y_ && y < high_y_ && x >= low_x_ && x <= high_x_)) return false;
    const std::size_t band = band_of(y);
    int winding = 0;
    for (std::uint32_t k = band_first_[band]; k < band_first_[band + 1]; ++k) {
      const OutlineEdge& edge = band_edges_[k];
      if (y >= edge.low_y && y < edge.high_y && edge.is_right_of(x, y)) winding += edge.sense;
    }
    return winding != 0;
  }

 private:
  void add(const std::array<double, 2>& from, const std::array<double, 2>& to) {
    if (from[1] == to[1]) return;  // no ray crosses a horizontal edge
    const bool up = from[1] < to[1];
    const auto& low = up ? from : to;
    const auto& high = up ? to : from;
    edges_.push_back({low[0], low[1], high[1], high[0] - low[0], high[1] - low[1], up ? 1 : -1});
  }

  std::size_t band_of(double y) const {
    const double band = (y - low_y_) * bands_per_height_;
    return std::min(static_cast<std::size_t>(band), band_first_.size() - 2);
  }

  void fill_bands() {
    std::size_t bands = std::min<std::size_t>(4 * edges_.size(), 4096);
    bands_per_height_ = static_cast<double>(bands) / (high_y_ - low_y_);
    if (!std::isfinite(bands_per_height_)) bands_per_height_ = 0, bands = 1;  // the height is almost 0
    band_first_.assign(bands + 1, 0);
    const auto each = [&](const auto& body) {
      for (const OutlineEdge& edge : edges_)
        for (std::size_t band = band_of(edge.low_y); band <= band_of(edge.high_y); ++band) body(edge, band);
    };
    each([&](const OutlineEdge&, std::size_t band) { ++band_first_[band + 1]; });
    for (std::size_t band = 0; band < bands; ++band) band_first_[band + 1] += band_first_[band];
    band_edges_.resize(band_first_.back());
    std::vector<std::uint32_t> next(band_first_.begin(), band_first_.end() - 1);
    each([&](const OutlineEdge& edge, std::size_t band) { band_edges_[next[band]++] = edge; });
  }

  std::vector<OutlineEdge> edges_;
  double low_x_ = std::numeric_limits<double>::infinity();
  double high_x_ = -std::numeric_limits<double>::infinity();
  double low_y_ = std::numeric_limits<double>::infinity();
  double high_y_ = -std::numeric_limits<double>::infinity();
  double bands_per_height_ = 0;
  std::vector<std::uint32_t> band_first_;
  std::vector<OutlineEdge> band_edges_;
};

}  // namespace

NodeSet inside_outline(const Model& model, const ViewMatrix& view, const std::vector<std::array<double, 2>>& outline) {
  const bool finite = std::all_of(outline.begin(), outline.end(), [](const auto& p) { return std::isfinite(p[0]) && std::isfinite(p[1]); });
  if (outline.size() < 3 || !finite) return {};
  const Outline inside(outline);
  std::vector<NodeSet> of_chunk(model.positions.chunk_count());
  parallel_for(model.positions.chunk_count(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<NodeIndex> found(kChunkSize);
    for (std::size_t c = begin; c < end; ++c) {
      const auto positions = model.positions.chunk(c);
      std::size_t count = 0;
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const double w = clip_row(view, 3, positions[i]);
        if (!(w > 0)) continue;  // behind the eye
        if (!inside.contains(clip_row(view, 0, positions[i]) / w, clip_row(view, 1, positions[i]) / w)) continue;
        if (model.is_removed(NodeIndex(c * kChunkSize + i))) continue;
        found[count++] = NodeIndex(c * kChunkSize + i);
      }
      of_chunk[c].assign(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    }
  });
  std::size_t total = 0;
  for (const NodeSet& part : of_chunk) total += part.size();
  NodeSet nodes;
  nodes.reserve(total);
  for (const NodeSet& part : of_chunk) nodes.insert(nodes.end(), part.begin(), part.end());
  return nodes;
}

}  // namespace prismesh::mesh::select
