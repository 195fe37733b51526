#include "mesh/contact/joints_of_parts.h"

#include <algorithm>
#include <tuple>

#include <Eigen/Geometry>

#include "mesh/contact/pair_regions.h"
#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

using Box = Eigen::AlignedBox3d;

void extend(Box& box, const Model& model, ShellIndex shell) {
  for (const NodeIndex node : model.shell(shell).node)
    if (const Vec3& corner = model.position(node); corner.allFinite()) box.extend(corner);
}

double max_thickness(const ContactThickness& thickness, const ShellSet& shells) {
  double max = 0;
  for (const ShellIndex shell : shells) max = std::max(max, thickness.of_shell[shell.value]);
  return max;
}

}  // namespace

JointsOfParts::JointsOfParts(const Model& model, std::span<const connections::JoinedSheets::Pair> joints) : model_(model) {
  joints_.reserve(joints.size());
  for (const auto& [one, other] : joints) {
    const SidedPair pair = in_order_of_parts(model, one, other);
    joints_.push_back({pair.part_a, pair.part_b, pair.a, pair.b});
  }
  sort_unique(joints_);
}

bool JointsOfParts::join_there(PartIndex part_a, PartIndex part_b, const ShellSet& shells_a, const ShellSet& shells_b,
                               const ContactThickness& thickness) const {
  auto joint = std::lower_bound(joints_.begin(), joints_.end(), std::tie(part_a, part_b),
                                [](const Joint& x, const auto& parts) { return std::tie(x.part_a, x.part_b) < parts; });
  Box box;
  for (; joint != joints_.end() && joint->part_a == part_a && joint->part_b == part_b; ++joint) {
    if (box.isEmpty()) {
      for (const ShellIndex shell : shells_a) extend(box, model_, shell);
      for (const ShellIndex shell : shells_b) extend(box, model_, shell);
      const double margin = max_thickness(thickness, shells_a) + max_thickness(thickness, shells_b);
      box.min().array() -= margin;
      box.max().array() += margin;
    }
    Box of_a, of_b;
    extend(of_a, model_, joint->a);
    extend(of_b, model_, joint->b);
    if (box.intersects(of_a) && box.intersects(of_b)) return true;
  }
  return false;
}

}  // namespace prismesh::mesh::contact
