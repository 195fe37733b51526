#include "mesh/contact/moved_shells.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/contact/close_pair.h"
#include "mesh/contact/shares_node.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kMovedGrain = 64;

/// Around the corners of a shell; empty if one can't be decided.
Eigen::AlignedBox3d box_about(const Model& model, ShellIndex shell) {
  Eigen::AlignedBox3d box;
  for (const NodeIndex node : model.shell(shell).node) {
    if (!can_decide(model.position(node))) return {};
    box.extend(model.position(node));
  }
  return box;
}

/// The search about one moved shell.
class TouchedBy {
 public:
  TouchedBy(const Model& model, const ContactThickness& thickness, ShellIndex shell)
      : model_(model), thickness_(thickness), shell_(shell), close_to_(model, thickness, 0, shell), centre_(centre_of(shell)) {}

  void take(ShellIndex other, double box_distance2) {
    if (box_distance2 <= 0 && !crossing_segments(model_, shell_, other).empty()) {
      crossed_.push_back(other);
      return;
    }
    if (!(thickness_.of_shell[shell_.value] > 0) || !(thickness_.of_shell[other.value] > 0)) return;
    const double reach = close_to_.reach(other);
    if (box_distance2 <= spatial::bound_of_square(reach * reach)) near_.emplace_back((centre_of(other) - centre_).squaredNorm(), other);
  }

  const std::vector<ShellIndex>& crossed() const { return crossed_; }
  bool any_near() const { return !near_.empty(); }
  /// Of those taken that it doesn't cross: the one whose centre is nearest, if it is too close.
  std::vector<CloseShells> nearest_close() { return close_of({&*std::min_element(near_.begin(), near_.end()), 1}); }
  std::vector<CloseShells> all_close() { return close_of(near_); }

 private:
  using Near = std::pair<double, ShellIndex>;  ///< with the square of the centres' distance

  Vec3 centre_of(ShellIndex shell) const {
    const ShellNodes& nodes = model_.shell(shell);
    return (model_.position(nodes.node[0]) + model_.position(nodes.node[1]) + model_.position(nodes.node[2]) +
            model_.position(nodes.node[3])) /
           4;
  }
  std::vector<CloseShells> close_of(std::span<const Near> others) {
    std::vector<CloseShells> found;
    for (const auto& [distance2, other] : others)
      if (const auto pair = close_to_.pair(other)) found.push_back(*pair);
    close_to_.leave_out_neighbours(found, 0);
    return found;
  }

  const Model& model_;
  const ContactThickness& thickness_;
  ShellIndex shell_;
  CloseTo close_to_;
  Vec3 centre_;
  std::vector<ShellIndex> crossed_;
  std::vector<Near> near_;
};

}  // namespace

MovedShells::MovedShells(const Model& model, const spatial::BoxTree& tree, std::shared_ptr<const ContactThickness> thickness,
                         const NodeSet& nodes, const ShellSet& shells)
    : model_(model), tree_(tree), thickness_(std::move(thickness)), nodes_(nodes), shells_(shells), is_moved_(model.shell_count(), 0) {
  for (const ShellIndex shell : shells_) is_moved_[shell.value] = 1;
  for (const double each : thickness_->of_shell) max_thickness_ = std::max(max_thickness_, each);
  for (const Touch& touch : touches(true)) before_.emplace_back(touch.moved, touch.other);
}

std::vector<Touch> MovedShells::touches(bool all) const {
  std::vector<std::vector<Touch>> of_range((shells_.size() + kMovedGrain - 1) / kMovedGrain);
  parallel_for(shells_.size(), kMovedGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Touch>& found = of_range[begin / kMovedGrain];
    for (std::size_t s = begin; s < end; ++s) add_touches(shells_[s], all, found);
  });
  std::vector<Touch> together;
  for (const auto& some : of_range) together.insert(together.end(), some.begin(), some.end());
  std::sort(together.begin(), together.end(),
            [](const Touch& x, const Touch& y) { return std::tie(x.moved, x.other) < std::tie(y.moved, y.other); });
  return together;
}

void MovedShells::add_touches(ShellIndex shell, bool all, std::vector<Touch>& found) const {
  const Eigen::AlignedBox3d box = box_about(model_, shell);
  if (box.isEmpty()) return;
  spatial::FloatBox own_box;
  own_box.add(box.min());
  own_box.add(box.max());
  const double own = thickness_->of_shell[shell.value];
  TouchedBy about(model_, *thickness_, shell);
  tree_.near_box(box.min(), box.max(), own > 0 ? (own + max_thickness_) / 2 : 0, [&](ShellIndex other, const spatial::FloatBox& its_box) {
    if (is_moved_[other.value] == 0 && !share_a_node(model_.shell(shell), model_.shell(other)))
      about.take(other, spatial::distance2(own_box, its_box));
    return true;
  });
  const std::size_t first = found.size();
  for (const ShellIndex other : about.crossed())
    if (!was_before(shell, other)) found.push_back({shell, other, true, 0});
  if (!about.any_near() || (!all && found.size() > first)) return;
  const auto add_close = [&](const std::vector<CloseShells>& pairs) {
    for (const CloseShells& pair : pairs)
      if (const ShellIndex other = pair.a == shell ? pair.b : pair.a; !was_before(shell, other))
        found.push_back({shell, other, false, pair.depth});
  };
  if (!all) add_close(about.nearest_close());
  if (all || found.size() == first) add_close(about.all_close());
}

bool MovedShells::was_before(ShellIndex moved, ShellIndex other) const {
  return std::binary_search(before_.begin(), before_.end(), std::pair(moved, other));
}

std::vector<Touch> MovedShells::at(std::span<const Vec3> positions) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) model_.positions.set(nodes_[i].value, positions[i]);
  return touches(false);
}

TouchSummary summary_of(const Model& model, std::span<const Touch> touches) {
  TouchSummary summary;
  const Touch* worst = &touches.front();
  std::vector<PartIndex> parts;
  for (const Touch& touch : touches) {
    parts.push_back(model.shell_parts[touch.moved.value]);
    parts.push_back(model.shell_parts[touch.other.value]);
    if (std::tie(touch.cross, touch.depth) > std::tie(worst->cross, worst->depth)) worst = &touch;
  }
  sort_unique(parts);
  summary.parts = parts.size();
  summary.part_a = model.shell_parts[worst->moved.value];
  summary.part_b = model.shell_parts[worst->other.value];
  summary.cross = worst->cross;
  summary.depth = worst->depth;
  return summary;
}

}  // namespace prismesh::mesh::contact
