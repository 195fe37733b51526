#include "kiosk/tools/shaping/handle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "kiosk/toolkit/arrow.h"
#include "kiosk/toolkit/selected_nodes.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using input::Pixel;
using input::Under;

using ipc::SnapshotArray;
using mesh::NodeIndex;
using render::ModelSource;

std::optional<NodeIndex> nearest_to_centre(const ModelSource& model) {
  const std::optional<Vec3> centre = toolkit::selection_centre(model);
  if (!centre) return std::nullopt;
  const std::size_t nodes = model.size(SnapshotArray::positions);
  std::optional<NodeIndex> best;
  double best_distance = std::numeric_limits<double>::infinity();
  toolkit::for_each_selected(model, [&](std::size_t n) {
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

namespace {

using toolkit::points_at_viewer;

constexpr double kSlackPixels = 8;
constexpr int kCircleSteps = 180;
constexpr double kMinBallShare = 0.25;  ///< of the arrow's length
constexpr double kMinFacing = 0.12;     ///< of a plane to the line of sight: under it a pointer can't be followed in the plane

bool on_disk_at(const stereo::Aim& aim, const Vec3& at, const Vec3& direction, const Pixel& pixel) {
  const Vec3 edge = stereo::handle_tip(aim, at, direction) - at;  // as long as the arrow
  const double radius = edge.norm() * render::kHandleDiskPixels / stereo::kHandleLengthPixels;
  const stereo::Ray ray = stereo::ray_through(aim, pixel);
  const double facing = ray.direction.dot(direction);
  if (facing == 0) return false;
  return (ray.origin + ray.direction * ((at - ray.origin).dot(direction) / facing) - at).norm() <= radius;
}

Vec3 turned(const Axis& axis, const Vec3& point, double degrees) {
  return axis.point + Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.direction) * (point - axis.point);
}

bool on_circle(const stereo::Aim& aim, const Axis& axis, const Vec3& at, const Pixel& pixel) {
  const auto ball = stereo::pixel_of(aim, at);
  if (ball && (*ball - pixel).norm() <= render::kHandleBallPixels + kSlackPixels) return true;
  std::optional<Pixel> before;
  for (int step = 0; step <= kCircleSteps; ++step) {
    const std::optional<Pixel> now = stereo::pixel_of(aim, turned(axis, at, 360.0 * step / kCircleSteps));
    if (before && now) {
      const Pixel way = *now - *before;
      const double length = way.squaredNorm(), share = length > 0 ? std::clamp((pixel - *before).dot(way) / length, 0.0, 1.0) : 0;
      if ((pixel - (*before + share * way)).norm() <= kSlackPixels) return true;
    }
    before = now;
  }
  return false;
}

}  // namespace

Under part_of_handle(const stereo::Aim& aim, const render::Handle& handle, const Pixel& pixel) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, handle.at);
  if (!foot) return Under::picture;
  if (handle.turn) return on_circle(aim, {handle.turn->point, handle.turn->axis}, handle.at, pixel) ? Under::turn_handle : Under::picture;
  const bool on_arrow = stereo::on_handle(aim, handle.at, handle.direction, pixel);
  if (on_arrow && points_at_viewer(aim, handle.at, handle.direction)) return Under::lift_handle;
  if ((*foot - pixel).norm() <= kRingRadiusPixels) return Under::move_handle;
  if (on_arrow) return Under::lift_handle;
  return on_disk_at(aim, handle.at, handle.direction, pixel) ? Under::slide_handle : Under::picture;
}

Vec3 arrow_direction(const stereo::Aim& aim, const Anchor& anchor) {
  const std::optional<Pixel> foot = stereo::pixel_of(aim, anchor.at);
  if (!foot) return anchor.normal;
  return anchor.normal.dot(stereo::ray_through(aim, *foot).direction) > 0 ? Vec3(-anchor.normal) : anchor.normal;
}

Vec3 ball_place(const stereo::Aim& aim, const Axis& axis, const Vec3& at) {
  const Vec3 centre = axis.point + axis.direction * (at - axis.point).dot(axis.direction);
  const double length = (stereo::handle_tip(aim, centre, axis.direction) - centre).norm();
  if ((at - centre).norm() >= kMinBallShare * length) return at;
  const auto pixel = stereo::pixel_of(aim, centre);
  const Vec3 sight = stereo::ray_through(aim, pixel.value_or(Pixel::Zero())).direction.normalized();
  Vec3 across = axis.direction.cross(sight);
  if (across.norm() < 1e-3) across = axis.direction.unitOrthogonal();
  return centre + across.normalized() * length;
}

HandlePull::HandlePull(const HandleGrab& grab, const stereo::Aim& aim)
    : handle_(grab.handle), start_(grab.at), direction_(grab.direction), axis_(grab.axis), taken_(grab.pixel) {
  hold(aim, grab.pixel, {});
}

void HandlePull::hold(const stereo::Aim& aim, const Pixel& pixel, const Pull& pull) {
  taken_ = pixel;
  held_ = pull;
  upward_ = points_at_viewer(aim, start_, direction_) || !stereo::distance_along(aim, start_, direction_, pixel);
  const Vec3 normal = axis_ ? axis_->direction : direction_;
  const stereo::Ray ray = stereo::ray_through(aim, pixel);
  sideways_ = std::abs(ray.direction.normalized().dot(normal)) < kMinFacing;
  when_taken_ = raw(aim, pixel);
}

double HandlePull::along(const stereo::Aim& aim, const Pixel& pixel) const {
  if (upward_) return (taken_.y() - pixel.y()) * aim.mm_per_pixel() / aim.view.mm_per_unit;
  return stereo::distance_along(aim, start_, direction_, pixel).value_or(when_taken_.distance);
}

/// The place under the pointer in the plane of the disk. Seen from its edge: what the pointer does across the screen, without what leads
/// out of the plane.
Vec3 HandlePull::on_disk(const stereo::Aim& aim, const Pixel& pixel) const {
  if (sideways_) {
    const Vec3 by = stereo::displacement_in_screen_plane(aim, start_, pixel);
    return by - direction_ * by.dot(direction_);
  }
  const stereo::Ray ray = stereo::ray_through(aim, pixel);
  const double facing = ray.direction.dot(direction_);
  const double at = (start_ - ray.origin).dot(direction_) / facing;
  if (!(at > 0) || !std::isfinite(at)) return when_taken_.by;  // above the horizon
  return ray.origin + ray.direction * at - start_;
}

/// The angle of the place under the pointer in the plane that is turned. Seen from its edge: as far as the pointer goes where the ball
/// goes.
double HandlePull::degrees(const stereo::Aim& aim, const Pixel& pixel) const {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const Vec3 centre = axis_->point + axis_->direction * (start_ - axis_->point).dot(axis_->direction);
  const Vec3 a = start_ - centre, b = axis_->direction.cross(a);
  if (!sideways_) {
    const stereo::Ray ray = stereo::ray_through(aim, pixel);
    const double at = (centre - ray.origin).dot(axis_->direction) / ray.direction.dot(axis_->direction);
    const Vec3 out = ray.origin + ray.direction * at - centre;
    if (at > 0 && std::isfinite(at)) return std::atan2(out.dot(b), out.dot(a)) * kDegrees;
    return when_taken_.degrees;
  }
  const Vec3 here = turned(*axis_, start_, held_.degrees), ahead = turned(*axis_, start_, held_.degrees + 1);
  const auto from = stereo::pixel_of(aim, here), to = stereo::pixel_of(aim, ahead);
  if (!from || !to || (*to - *from).norm() < 1e-9) return 0;
  return (pixel - taken_).dot(*to - *from) / (*to - *from).squaredNorm();
}

Pull HandlePull::raw(const stereo::Aim& aim, const Pixel& pixel) const {
  Pull pull;
  switch (handle_) {
    case Under::move_handle: pull.by = stereo::displacement_in_screen_plane(aim, start_, pixel); break;
    case Under::slide_handle: pull.by = on_disk(aim, pixel); break;
    case Under::turn_handle: pull.degrees = degrees(aim, pixel); break;
    default: pull.distance = along(aim, pixel); break;
  }
  return pull;
}

Pull HandlePull::at(const stereo::Aim& aim, const Pixel& pixel, const Pull& before) const {
  const Pull now = raw(aim, pixel);
  Pull pull;
  pull.by = held_.by + now.by - when_taken_.by;
  pull.distance = held_.distance + sense_ * (now.distance - when_taken_.distance);
  pull.degrees = held_.degrees + now.degrees - when_taken_.degrees;
  if (handle_ == Under::turn_handle && !sideways_) pull.degrees -= 360 * std::round((pull.degrees - before.degrees) / 360);
  return pull;
}

Vec3 HandlePull::foot(const Pull& pull) const {
  if (handle_ == Under::turn_handle) return turned(*axis_, start_, pull.degrees);
  return start_ + pull.by + direction_ * (sense_ * pull.distance);
}

void HandlePull::set_axis(const stereo::Aim& aim, const Vec3& at, const Vec3& normal) {
  if (handle_ == Under::turn_handle) return;  // its ball may stand beside the grab
  start_ = at;
  if (normal.norm() > 0) {
    sense_ = normal.dot(direction_) < 0 ? -1 : 1;
    direction_ = sense_ * normal;
  }
  if (!upward_ || handle_ != Under::lift_handle) when_taken_ = raw(aim, taken_);
}

}  // namespace prismesh::kiosk::tools::shaping
