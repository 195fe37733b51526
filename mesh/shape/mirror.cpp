#include "mesh/shape/mirror.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "mesh/model/adjacency.h"

namespace prismesh::mesh::shape {

namespace {

constexpr double kShareOfSide = 0.25;       // of the shortest side: how far an image may be from the mirrored position
constexpr double kEquallyClose = 1.0 / 64;  // of that distance

/// The shortest side of the shells at a node; 0 without any.
double min_side(const Model& model, NodeIndex node) {
  double min_side2 = std::numeric_limits<double>::infinity();
  for (const ShellIndex index : model.adjacency->shells_of(node)) {
    const ShellNodes& shell = model.shell(index);
    const int corners = shell.corners();
    const int at = static_cast<int>(std::find(shell.node.begin(), shell.node.begin() + corners, node) - shell.node.begin());
    for (const NodeIndex other : {shell.node[(at + 1) % corners], shell.node[(at + corners - 1) % corners]}) {
      const double side2 = (model.position(other) - model.position(node)).squaredNorm();
      if (side2 > 0) min_side2 = std::min(min_side2, side2);
    }
  }
  return std::isfinite(min_side2) ? std::sqrt(min_side2) : 0;
}

std::vector<double> tolerances(const Model& model, const NodeSet& nodes) {
  std::vector<double> tolerance;
  std::vector<double> known;
  for (const NodeIndex node : nodes) {
    tolerance.push_back(kShareOfSide * min_side(model, node));
    if (tolerance.back() > 0) known.push_back(tolerance.back());
  }
  if (known.empty()) return tolerance;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  for (double& each : tolerance)
    if (!(each > 0)) each = *middle;
  return tolerance;
}

/// Finds the balls that contain a point: a hash table of cells, each at least as wide as the largest ball.
class Balls {
 public:
  Balls(std::vector<Vec3> centres, std::vector<double> radii) : centres_(std::move(centres)), radii_(std::move(radii)) {
    const double max_radius = *std::max_element(radii_.begin(), radii_.end());
    low_ = high_ = centres_.front();
    for (const Vec3& centre : centres_) {
      low_ = low_.cwiseMin(centre);
      high_ = high_.cwiseMax(centre);
    }
    low_.array() -= max_radius;
    high_.array() += max_radius;
    // wide enough that a cell's number can't overflow
    cell_ = std::max(2 * max_radius, (high_ - low_).maxCoeff() / (1 << 20));
    if (!(cell_ > 0)) cell_ = 1;
    heads_.assign(std::bit_ceil(8 * centres_.size()), kEnd);
    for (std::uint32_t ball = 0; ball < centres_.size(); ++ball) put(ball);
  }

  template <class Visit>
  void holding(const Vec3& point, Visit&& visit) const {
    if ((point.array() < low_.array()).any() || (point.array() > high_.array()).any()) return;
    for (std::uint32_t entry = heads_[slot(cell_of(point))]; entry != kEnd; entry = entries_[entry].next) {
      const std::uint32_t ball = entries_[entry].ball;
      const double distance = (centres_[ball] - point).norm();
      if (distance <= radii_[ball]) visit(ball, distance);
    }
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Entry {
    std::uint32_t ball = 0;
    std::uint32_t next = kEnd;
  };

  Cell cell_of(const Vec3& point) const { return ((point - low_) / cell_).array().floor().cast<std::int64_t>(); }
  std::size_t slot(const Cell& cell) const {
    const std::uint64_t mixed = static_cast<std::uint64_t>(cell.x()) * 0x9e3779b97f4a7c15u ^
                                static_cast<std::uint64_t>(cell.y()) * 0xc2b2ae3d27d4eb4fu ^
                                static_cast<std::uint64_t>(cell.z()) * 0x165667b19e3779f9u;
    return (mixed ^ mixed >> 29) & (heads_.size() - 1);
  }
  /// Enters the ball once into each slot that a point in it can hash to.
  void put(std::uint32_t ball) {
    const Vec3 reach = Vec3::Constant(radii_[ball]);
    const Cell from = cell_of(centres_[ball] - reach);
    const Cell to = cell_of(centres_[ball] + reach);
    for (std::int64_t x = from.x(); x <= to.x(); ++x)
      for (std::int64_t y = from.y(); y <= to.y(); ++y)
        for (std::int64_t z = from.z(); z <= to.z(); ++z) {
          std::uint32_t& head = heads_[slot(Cell(x, y, z))];
          if (head != kEnd && entries_[head].ball == ball) continue;
          entries_.push_back({ball, head});
          head = static_cast<std::uint32_t>(entries_.size() - 1);
        }
  }

  std::vector<Vec3> centres_;
  std::vector<double> radii_;
  Vec3 low_, high_;
  double cell_ = 1;
  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
};

/// A node and another one near its mirrored position.
struct Pair {
  std::uint32_t closeness = 0;  ///< in steps of what counts as equally close
  bool other_part = false;
  NodeIndex low, high;
  auto operator<=>(const Pair&) const = default;
};

PartIndex part_at(const Model& model, NodeIndex node) {
  const auto shells = model.adjacency->shells_of(node);
  return shells.empty() ? PartIndex() : model.shell_parts[shells.front().value];
}

std::vector<Pair> close_pairs(const Model& model, const NodeSet& nodes, const Plane& plane) {
  const std::vector<double> tolerance = tolerances(model, nodes);
  std::vector<Vec3> positions;
  for (const NodeIndex node : nodes) positions.push_back(plane.mirrored_position(model.position(node)));
  const Balls balls(std::move(positions), tolerance);
  std::vector<Pair> pairs;
  std::size_t at = 0;
  for (std::size_t c = 0; c < model.positions.chunk_count(); ++c)
    for (const Vec3& position : model.positions.chunk(c)) {
      const NodeIndex other(at++);
      balls.holding(position, [&](std::uint32_t ball, double distance) {
        if (model.is_removed(other)) return;
        const NodeIndex node = nodes[ball];
        const double steps = tolerance[ball] > 0 ? distance / (tolerance[ball] * kEquallyClose) : 0;
        pairs.push_back({static_cast<std::uint32_t>(steps), part_at(model, node) != part_at(model, other), std::min(node, other),
                         std::max(node, other)});
      });
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<NodeIndex> find_images(const Model& model, const NodeSet& nodes, const Plane& plane) {
  if (nodes.empty()) return {};
  const std::vector<Pair> pairs = close_pairs(model, nodes, plane);
  std::vector<NodeIndex> all;
  for (const Pair& pair : pairs) {
    all.push_back(pair.low);
    all.push_back(pair.high);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<NodeIndex> image(all.size());
  const auto image_of = [&](NodeIndex node) -> NodeIndex& {
    return image[static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), node) - all.begin())];
  };
  for (const Pair& pair : pairs) {
    if (image_of(pair.low).valid() || image_of(pair.high).valid()) continue;
    image_of(pair.low) = pair.high;
    image_of(pair.high) = pair.low;
  }
  std::vector<NodeIndex> found;
  for (const NodeIndex node : nodes) found.push_back(std::binary_search(all.begin(), all.end(), node) ? image_of(node) : NodeIndex());
  return found;
}

void find_shares(const Plane& plane, std::span<const Vec3> start, std::span<const double> weight, const Vec3& grab,
                 std::span<Mirrored> nodes) {
  const double grab_height = plane.height(grab);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t image = nodes[i].image;
    if (image == Mirrored::kNone) continue;
    // -1 on the far side of the plane to 1 on the grab's side; exactly the opposite number for the image
    const double height = (plane.height(start[i]) - plane.height(start[image])) / 2;
    const double side = std::clamp(std::abs(grab_height) > 0 ? height / grab_height : 0.0, -1.0, 1.0);
    const double own = weight[i] * (1 + side);
    const double others = weight[image] * (1 - side);
    if (own + others > 0)
      nodes[i].own = own / (own + others);
    else
      nodes[i].own = weight[i] > 0 ? 1 : 0;
  }
}

std::vector<Vec3> mirror_moves(const Plane& plane, std::span<const Mirrored> nodes, std::span<const Vec3> moves) {
  std::vector<Vec3> both(moves.begin(), moves.end());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t image = nodes[i].image;
    if (image == Mirrored::kNone) continue;
    both[i] = nodes[i].own * moves[i] + nodes[image].own * plane.mirrored(moves[image]);
  }
  return both;
}

}  // namespace prismesh::mesh::shape
