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

}  // namespace

MovedShells::MovedShells(const Model& model, const spatial::BoxTree& tree, std::shared_ptr<const ContactThickness> thickness,
                         const NodeSet& nodes, const ShellSet& shells)
    : model_(model), tree_(tree), thickness_(std::move(thickness)), nodes_(nodes), shells_(shells), is_moved_(model.shell_count(), 0) {
  for (const ShellIndex shell : shells_) is_moved_[shell.value] = 1;
  for (const double each : thickness_->of_shell) max_thickness_ = std::max(max_thickness_, each);
  for (const Touch& touch : all_touches()) before_.emplace_back(touch.moved, touch.other);
}

std::vector<Touch> MovedShells::all_touches() const {
  std::vector<std::vector<Touch>> of_range((shells_.size() + kMovedGrain - 1) / kMovedGrain);
  parallel_for(shells_.size(), kMovedGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Touch>& found = of_range[begin / kMovedGrain];
    std::vector<CloseShells> close;
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell = shells_[s];
      const Eigen::AlignedBox3d box = box_about(model_, shell);
      if (box.isEmpty()) continue;
      const double own = thickness_->of_shell[shell.value];
      spatial::FloatBox own_box;
      own_box.add(box.min());
      own_box.add(box.max());
      CloseTo close_to(model_, *thickness_, 0, shell);
      close.clear();
      tree_.near_box(box.min(), box.max(), own > 0 ? (own + max_thickness_) / 2 : 0,
                     [&](ShellIndex other, const spatial::FloatBox& its_box) {
                       if (is_moved_[other.value] != 0 || share_a_node(model_.shell(shell), model_.shell(other))) return true;
                       const double distance2 = spatial::distance2(own_box, its_box);
                       if (distance2 <= 0 && !crossing_segments(model_, shell, other).empty()) {
                         found.push_back({shell, other, true, 0});
                         return true;
                       }
                       if (!(own > 0) || !(thickness_->of_shell[other.value] > 0)) return true;
                       const double reach = close_to.reach(other);
                       if (!(distance2 <= spatial::bound_of_square(reach * reach))) return true;
                       if (const auto pair = close_to.pair(other)) close.push_back(*pair);
                       return true;
                     });
      close_to.leave_out_neighbours(close, 0);
      for (const CloseShells& pair : close) found.push_back({shell, pair.a == shell ? pair.b : pair.a, false, pair.depth});
    }
  });
  std::vector<Touch> all;
  for (const auto& some : of_range) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end(), [](const Touch& x, const Touch& y) { return std::tie(x.moved, x.other) < std::tie(y.moved, y.other); });
  return all;
}

std::vector<Touch> MovedShells::at(std::span<const Vec3> positions) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) model_.positions.set(nodes_[i].value, positions[i]);
  std::vector<Touch> touches = all_touches();
  std::erase_if(
      touches, [&](const Touch& touch) { return std::binary_search(before_.begin(), before_.end(), std::pair(touch.moved, touch.other)); });
  return touches;
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
