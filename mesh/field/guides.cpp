#include "mesh/field/guides.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"

namespace prismesh::mesh::field {

namespace {

constexpr std::size_t kMaxGuidingShells = 2000;  ///< some 0.3 ms
constexpr int kReaches = 3;                      ///< whole, half, quarter

struct FoundGuide {
  double distance_mm = 0;
  NodeIndex low, high;  ///< equal: a node
  Vec3 from_mm, to_mm;

  auto order() const { return std::tuple(distance_mm, low != high, low.value, high.value); }
};

double distance_to_segment(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 along = to - from;
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0;
  return (from + share * along - point).norm();
}

/// Empty if there are too many.
std::vector<ShellIndex> shells_near(const spatial::BoxTree& tree, const Placement& placement, const Vec3& pen_mm) {
  const Vec3 pen = placement.to_model(pen_mm);
  std::vector<ShellIndex> shells;
  double reach_mm = kGuideReachMm;
  for (int i = 0; i < kReaches; ++i, reach_mm /= 2) {
    shells.clear();
    tree.near_box(pen, pen, reach_mm / placement.scale, [&](ShellIndex shell, const spatial::FloatBox&) {
      shells.push_back(shell);
      return shells.size() <= kMaxGuidingShells;
    });
    if (shells.size() <= kMaxGuidingShells) return shells;
  }
  return {};
}

class GuideFinder {
 public:
  GuideFinder(const Model& model, const spatial::BoxTree& tree, const Placement& placement, const Vec3& pen_mm)
      : model_(model), tree_(tree), placement_(placement), pen_mm_(pen_mm) {}

  void add(ShellIndex shell) {
    const ShellNodes& nodes = tree_.corners(shell);
    const std::size_t corners = nodes.is_triangle() ? 3 : 4;
    std::array<Vec3, 4> at_mm;
    for (std::size_t i = 0; i < corners; ++i) {
      at_mm[i] = placement_.to_pen(tree_.position(nodes.node[i]));
      if (!at_mm[i].allFinite()) return;
    }
    double shortest_mm = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t next = (i + 1) % corners;
      shortest_mm = std::min(shortest_mm, (at_mm[next] - at_mm[i]).norm());
      add_edge(nodes.node[i], nodes.node[next], at_mm[i], at_mm[next]);
    }
    if (shortest_mm < kNodeGuideEdgeMm) return;
    for (std::size_t i = 0; i < corners; ++i) keep({(at_mm[i] - pen_mm_).norm(), nodes.node[i], nodes.node[i], at_mm[i], at_mm[i]});
  }

  void fill(HapticGuides& guides) {
    const auto before = [](const FoundGuide& a, const FoundGuide& b) { return a.order() < b.order(); };
    const auto same = [](const FoundGuide& a, const FoundGuide& b) { return a.low == b.low && a.high == b.high; };
    std::sort(found_.begin(), found_.end(), before);
    found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
    const std::size_t count = std::min<std::size_t>(found_.size(), kMaxGuides);
    guides.count = static_cast<std::int32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Map<Vec3>(guides.guides[i].from_mm) = found_[i].from_mm;
      Eigen::Map<Vec3>(guides.guides[i].to_mm) = found_[i].to_mm;
    }
  }

 private:
  void add_edge(NodeIndex a, NodeIndex b, const Vec3& a_mm, const Vec3& b_mm) {
    const bool ascends = a < b;
    const Edge ends = ascends ? Edge{a, b} : Edge{b, a};
    // From the low end, so that both shells at the edge give the same bits.
    const Vec3 &from = ascends ? a_mm : b_mm, &to = ascends ? b_mm : a_mm;
    const double distance_mm = distance_to_segment(from, to, pen_mm_);
    if (!(distance_mm <= kGuideReachMm)) return;
    const EdgeIndex edge = model_.adjacency->find_edge(ends.low, ends.high);
    if (!edge.valid() || classify_edge(model_, edge, ends, kGuideCreaseDegrees) == EdgeKind::smooth) return;
    keep({distance_mm, ends.low, ends.high, from, to});
  }
  void keep(const FoundGuide& guide) {
    if (guide.distance_mm <= kGuideReachMm) found_.push_back(guide);
  }

  const Model& model_;
  const spatial::BoxTree& tree_;
  const Placement& placement_;
  const Vec3& pen_mm_;
  std::vector<FoundGuide> found_;
};

}  // namespace

void find_guides(const Model& model, const spatial::BoxTree& tree, const Placement& placement, const Vec3& pen_mm, HapticGuides& guides) {
  GuideFinder finder(model, tree, placement, pen_mm);
  for (const ShellIndex shell : shells_near(tree, placement, pen_mm)) finder.add(shell);
  finder.fill(guides);
}

}  // namespace prismesh::mesh::field
