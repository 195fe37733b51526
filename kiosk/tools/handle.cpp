#include "kiosk/tools/handle.h"

#include <array>
#include <limits>

#include <Eigen/Geometry>

namespace prismesh::kiosk::tools {
namespace {

using ipc::SnapshotArray;
using mesh::NodeIndex;
using render::ModelSource;

/// Calls `visit(index)` for every selected node.
template <class Visit>
void for_each_selected(const ModelSource& model, const Visit& visit) {
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::node_marks); ++c) {
    const auto marks = model.chunk<std::uint8_t>(SnapshotArray::node_marks, c);
    for (std::size_t i = 0; i < marks.size(); ++i)
      if ((marks[i] & mesh::document::kSelected) != 0) visit(c * mesh::kChunkSize + i);
  }
}

std::optional<NodeIndex> nearest_to_centre(const ModelSource& model) {
  const std::optional<Vec3> centre = selection_centre(model);
  if (!centre) return std::nullopt;
  const std::size_t nodes = model.size(SnapshotArray::positions);
  std::optional<NodeIndex> best;
  double best_distance = std::numeric_limits<double>::infinity();
  for_each_selected(model, [&](std::size_t n) {
    if (n >= nodes) return;
    const double distance = (model.at<Vec3>(SnapshotArray::positions, n) - *centre).squaredNorm();
    if (!(distance < best_distance)) return;
    best_distance = distance;
    best = NodeIndex(n);
  });
  return best;
}

/// Area-weighted normal of a shell from its diagonals (triangle: two edges).
Vec3 area_normal(const ModelSource& model, const mesh::ShellNodes& shell) {
  const std::size_t nodes = model.size(SnapshotArray::positions);
  std::array<Vec3, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    if (shell.node[i].value >= nodes) return Vec3::Zero();
    p[i] = model.at<Vec3>(SnapshotArray::positions, shell.node[i].value);
  }
  return (p[2] - p[0]).cross(p[3] - p[1]);
}

Vec3 normal_at(const ModelSource& model, NodeIndex node) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::shell_nodes); ++c)
    for (const mesh::ShellNodes& shell : model.chunk<mesh::ShellNodes>(SnapshotArray::shell_nodes, c)) {
      if (shell.node[0] != node && shell.node[1] != node && shell.node[2] != node && shell.node[3] != node) continue;
      const Vec3 normal = area_normal(model, shell);
      sum += sum.dot(normal) < 0 ? Vec3(-normal) : normal;
    }
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3::UnitZ();
}

}  // namespace

std::optional<Vec3> selection_centre(const ModelSource& model) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  const std::size_t nodes = model.size(SnapshotArray::positions);
  for_each_selected(model, [&](std::size_t n) {
    if (n >= nodes) return;
    sum += model.at<Vec3>(SnapshotArray::positions, n);
    ++count;
  });
  return count == 0 ? std::nullopt : std::optional<Vec3>(sum / static_cast<double>(count));
}

std::optional<Anchor> anchor_of_selection(const ModelSource& model, std::optional<NodeIndex> preferred) {
  std::optional<NodeIndex> node;
  if (preferred && preferred->value < model.size(SnapshotArray::node_marks) &&
      (model.at<std::uint8_t>(SnapshotArray::node_marks, preferred->value) & mesh::document::kSelected) != 0)
    node = preferred;
  else
    node = nearest_to_centre(model);
  if (!node || node->value >= model.size(SnapshotArray::node_ids)) return std::nullopt;
  return Anchor{*node, model.at<std::int64_t>(SnapshotArray::node_ids, node->value), model.at<Vec3>(SnapshotArray::positions, node->value),
                normal_at(model, *node)};
}

bool points_at_viewer(const stereo::Aim& aim, const Vec3& at, const Vec3& direction) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, at), tip = stereo::pixel_of(aim, stereo::handle_tip(aim, at, direction));
  return !foot || !tip || (*tip - *foot).norm() < 2 * kRingRadiusPixels;
}

Under part_of_handle(const stereo::Aim& aim, const Vec3& at, const Vec3& direction, const Pixel& pixel) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, at);
  if (!foot) return Under::picture;
  const bool on_arrow = stereo::on_handle(aim, at, direction, pixel);
  if (on_arrow && points_at_viewer(aim, at, direction)) return Under::lift_handle;
  if ((*foot - pixel).norm() <= kRingRadiusPixels) return Under::move_handle;
  return on_arrow ? Under::lift_handle : Under::picture;
}

Vec3 arrow_direction(const stereo::Aim& aim, const Anchor& anchor) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, anchor.at);
  if (!foot) return anchor.normal;
  return anchor.normal.dot(stereo::ray_through(aim, *foot).direction) > 0 ? Vec3(-anchor.normal) : anchor.normal;
}

HandlePull::HandlePull(Under handle, const Vec3& at, const Vec3& direction, const stereo::Aim& aim, const Pixel& pixel)
    : handle_(handle), start_(at), direction_(direction), taken_(pixel) {
  const std::optional<double> along_axis = stereo::distance_along(aim, start_, direction_, pixel);
  upward_ = !along_axis || points_at_viewer(aim, start_, direction_);
  along_when_taken_ = along_axis.value_or(0);
  offset_when_taken_ = stereo::displacement_in_screen_plane(aim, start_, pixel);
}

double HandlePull::along(const stereo::Aim& aim, const Pixel& pixel) const {
  if (upward_) return (taken_.y() - pixel.y()) * aim.mm_per_pixel() / aim.view.mm_per_unit;
  return stereo::distance_along(aim, start_, direction_, pixel).value_or(along_when_taken_);
}

Pull HandlePull::at(const stereo::Aim& aim, const Pixel& pixel) const {
  Pull pull;
  if (handle_ == Under::move_handle)
    pull.by = stereo::displacement_in_screen_plane(aim, start_, pixel) - offset_when_taken_;
  else
    pull.distance = sense_ * (along(aim, pixel) - along_when_taken_);
  return pull;
}

Vec3 HandlePull::foot(const Pull& pull) const { return start_ + pull.by + direction_ * (sense_ * pull.distance); }

void HandlePull::set_axis(const stereo::Aim& aim, const Vec3& at, const Vec3& normal) {
  sense_ = normal.dot(direction_) < 0 ? -1 : 1;
  start_ = at;
  direction_ = sense_ * normal;
  if (!upward_) along_when_taken_ = stereo::distance_along(aim, start_, direction_, taken_).value_or(along_when_taken_);
  offset_when_taken_ = stereo::displacement_in_screen_plane(aim, start_, taken_);
}

}  // namespace prismesh::kiosk::tools
