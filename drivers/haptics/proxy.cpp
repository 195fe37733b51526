#include "drivers/haptics/proxy.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace prismesh::drivers::haptics {
namespace {

/// Where the proxy aims when it slides: a little above the distance at which steps end, so that rounding doesn't stop it.
constexpr double kAimSpacings = kContactSpacings + 0.01;
/// Clearances below this aren't used: they are of the size of rounding.
constexpr double kMinClearanceMm = 1e-3;
/// The share of the clearance that a part of a motion may use up.
constexpr double kCarryShare = 0.7;

double contact_mm(const FieldSample& at) { return kContactSpacings * at.spacing_mm; }

}  // namespace

void Proxy::note(ProxyPath* path, const Eigen::Vector3d& place_mm, double part) {
  if (path == nullptr || path->count == path->places_mm.size()) return;
  path->places_mm[path->count] = place_mm;
  path->part[path->count++] = part;
}

ProxyContact Proxy::step(const HapticField* field, const Eigen::Vector3d& pen_mm, double friction, ProxyPath* path) {
  ProxyContact contact;
  if (path != nullptr) path->count = 0;
  const bool was_attached = attached_;
  if (field == nullptr || !usable(*field) || !pen_mm.allFinite() || !sample(*field, pen_mm).known) {
    attached_ = false;
  } else {
    if (attached_) note(path, place_mm_, 0);
    if (attached_ && !follow_field(*field, path)) attached_ = false;
    if (!attached_ && !was_attached) attach(*field, pen_mm);
  }
  contact.let_go = was_attached && !attached_;
  contact.attached = attached_;
  if (!attached_) return contact;
  note(path, place_mm_, 1);
  rise_to_contact(*field);
  note(path, place_mm_, 1);
  while (contact.steps < kMaxProxySteps && walk_step(*field, pen_mm, std::max(0.0, friction), contact)) {
    ++contact.steps;
    note(path, place_mm_, 1);
  }
  contact.proxy_mm = place_mm_;
  contact.element = contact.touching ? here_.element : -1;
  return contact;
}

/// Begins in free space only.
void Proxy::attach(const HapticField& field, const Eigen::Vector3d& pen_mm) {
  here_ = sample(field, pen_mm);
  if (!here_.known || here_.distance_mm < contact_mm(here_) || here_.proved_mm < kMinClearanceMm) return;
  attached_ = true;
  place_mm_ = pen_mm;
  clearance_mm_ = here_.proved_mm;
  generation_ = field.mesh_generation;
  placement_ = field.placement;
  number_ = field.number;
}

/// Takes over a new field. Returns false where nothing is proved.
bool Proxy::follow_field(const HapticField& field, ProxyPath* path) {
  if (field.placement != placement_) return false;
  if (field.mesh_generation != generation_ && (field.before_generation != generation_ || !carry(field, path))) return false;
  generation_ = field.mesh_generation;
  if (field.number != number_ || !here_.known) here_ = sample(field, place_mm_);
  number_ = field.number;
  if (!here_.known) return false;
  clearance_mm_ = std::max(clearance_mm_, here_.proved_mm);
  return clearance_mm_ >= kMinClearanceMm;
}

/// Carries the proxy through the motion of the shells.
bool Proxy::carry(const HapticField& field, ProxyPath* path) {
  here_ = sample(field, place_mm_);
  if (field.max_moved_mm < clearance_mm_ - kMinClearanceMm) {
    clearance_mm_ -= field.max_moved_mm;
    return true;
  }
  static_mm_ = std::max(clearance_mm_, proved_still_mm(field, place_mm_));
  MovedNearest nearest = nearest_moved(field, place_mm_, 0);
  if (!nearest.known || nearest.distance_mm < kMinClearanceMm) return false;
  // Keeps the distance that it has, so that the force doesn't jump.
  const double spacing_mm = field.fine.spacing_mm;
  const double hold_mm = std::min(std::clamp(nearest.distance_mm, spacing_mm, kAimSpacings * spacing_mm), field.moved_reach_mm);
  double part = 0;
  for (int i = 0; i < kMaxCarrySteps; ++i) {
    if (nearest.distance_mm < hold_mm && !push_away(field, part, hold_mm, nearest, path)) return false;
    if (part >= 1) {
      clearance_mm_ = std::min(static_mm_, nearest.distance_mm);
      here_ = sample(field, place_mm_);
      return true;
    }
    part = std::min(1.0, part + kCarryShare * (nearest.distance_mm - kMinClearanceMm) / field.max_moved_mm);
    nearest = nearest_moved(field, place_mm_, part);
    if (!nearest.known || nearest.distance_mm < kMinClearanceMm) return false;
    note(path, place_mm_, part);
  }
  return false;
}

/// Pushes the proxy away from the nearest moved shell, up to the distance to hold. Shorter where other shells are in the way. Returns false
/// where it is pinched.
bool Proxy::push_away(const HapticField& field, double part, double hold_mm, MovedNearest& nearest, ProxyPath* path) {
  const Eigen::Vector3d away = (place_mm_ - nearest.point_mm) / nearest.distance_mm;
  for (double step_mm = hold_mm - nearest.distance_mm; step_mm > 0.05 * hold_mm; step_mm /= 2) {
    const Eigen::Vector3d to_mm = place_mm_ + step_mm * away;
    const MovedNearest moved = nearest_moved(field, to_mm, part);
    if (!moved.known) continue;
    const double still_mm = std::max(static_mm_ - step_mm, proved_still_mm(field, to_mm));
    if (static_mm_ + still_mm <= step_mm || still_mm < kMinClearanceMm) continue;
    if (nearest.distance_mm + moved.distance_mm <= step_mm || moved.distance_mm < nearest.distance_mm) continue;
    place_mm_ = to_mm;
    static_mm_ = still_mm;
    nearest = moved;
    note(path, place_mm_, part);
    return true;
  }
  return nearest.distance_mm > 0.3 * hold_mm;
}

/// Takes a step if no shell can be in its way and it doesn't come nearer to shells than the contact distance; where it already is nearer,
/// it must not come nearer still. `there`: what the field says at the end, also where the step is refused.
bool Proxy::try_step(const HapticField& field, const Eigen::Vector3d& to_mm, FieldSample* there) {
  const FieldSample end = sample(field, to_mm);
  if (there != nullptr) *there = end;
  if (!end.known) return false;
  const double step_mm = (to_mm - place_mm_).norm();
  const double clearance_mm = std::max(end.proved_mm, clearance_mm_ - step_mm);
  if (clearance_mm_ + clearance_mm <= step_mm || clearance_mm < kMinClearanceMm) return false;
  if (end.distance_mm < contact_mm(end) && end.distance_mm < here_.distance_mm) return false;
  place_mm_ = to_mm;
  clearance_mm_ = clearance_mm;
  here_ = end;
  return true;
}

/// A new brick may say that the proxy is too near: it rises along the gradient.
void Proxy::rise_to_contact(const HapticField& field) {
  for (int i = 0; i < 4 && here_.distance_mm < contact_mm(here_); ++i) {
    const double slope = here_.gradient.norm();
    if (slope < 0.1) return;
    const double step_mm = std::min(kAimSpacings * here_.spacing_mm - here_.distance_mm, kStepSpacings * here_.spacing_mm);
    if (!try_step(field, place_mm_ + step_mm / slope * here_.gradient, nullptr)) return;
  }
}

/// One step toward the pen: straight, else up to the contact distance, else along the shells. Returns false where the proxy rests.
bool Proxy::walk_step(const HapticField& field, const Eigen::Vector3d& pen_mm, double friction, ProxyContact& contact) {
  const Eigen::Vector3d way_mm = pen_mm - place_mm_;
  const double length_mm = way_mm.norm();
  if (length_mm < 1e-9) return false;
  const double step_mm = std::min(length_mm, kStepSpacings * here_.spacing_mm);
  const Eigen::Vector3d toward = way_mm / length_mm;
  FieldSample there;
  const FieldSample before = here_;
  if (try_step(field, place_mm_ + step_mm * toward, &there)) return true;
  contact.touching = true;
  if (!there.known) return false;
  const double slope = there.gradient.norm();
  if (slope < 0.1) return false;
  const Eigen::Vector3d normal = there.gradient / slope;
  contact.normal = normal;
  // Up to the contact distance, by the secant.
  const double above_mm = before.distance_mm - kAimSpacings * before.spacing_mm, fall_mm = before.distance_mm - there.distance_mm;
  if (above_mm > 0.01 * before.spacing_mm && fall_mm > above_mm &&
      try_step(field, place_mm_ + step_mm * above_mm / fall_mm * toward, nullptr))
    return true;
  return slide(field, pen_mm, normal, friction);
}

/// Slides along the shells as far as the friction lets it, and along a crease where two shells hold it.
bool Proxy::slide(const HapticField& field, const Eigen::Vector3d& pen_mm, const Eigen::Vector3d& normal, double friction) {
  const Eigen::Vector3d way_mm = pen_mm - place_mm_;
  const double depth_mm = std::max(0.0, -way_mm.dot(normal));
  const Eigen::Vector3d along_mm = way_mm + depth_mm * normal;
  const double free_mm = along_mm.norm() - friction * depth_mm;
  const double max_step_mm = kStepSpacings * here_.spacing_mm;
  if (free_mm < 1e-4 * here_.spacing_mm) return false;
  const double min_gain_mm = 1e-5 * here_.spacing_mm, length_mm = way_mm.norm();
  // Aims at the contact distance above the end of the step.
  const auto lifted = [&](Eigen::Vector3d to_mm, Eigen::Vector3d* at_end) {
    const FieldSample end = sample(field, to_mm);
    const double slope = end.gradient.norm();
    if (!end.known || slope < 0.1) return to_mm;
    if (at_end != nullptr) *at_end = end.gradient / slope;
    const double low_mm = kAimSpacings * end.spacing_mm - end.distance_mm;
    if (low_mm > 0) to_mm += std::min(low_mm / slope, max_step_mm) / slope * end.gradient;
    const Eigen::Vector3d step_mm = to_mm - place_mm_;
    return step_mm.norm() > max_step_mm ? Eigen::Vector3d(place_mm_ + step_mm * (max_step_mm / step_mm.norm())) : to_mm;
  };
  const auto gains = [&](const Eigen::Vector3d& to_mm) { return (pen_mm - to_mm).norm() < length_mm - min_gain_mm; };
  Eigen::Vector3d other = normal;
  const Eigen::Vector3d to_mm = lifted(place_mm_ + along_mm.normalized() * std::min(free_mm, 0.8 * max_step_mm), &other);
  if (gains(to_mm) && try_step(field, to_mm, nullptr)) return true;
  const Eigen::Vector3d crease = normal.cross(other);
  if (crease.norm() < 1e-3) return false;
  const Eigen::Vector3d line = crease.normalized();
  const double on_line_mm = way_mm.dot(line);
  const double held_mm = (way_mm - on_line_mm * line).norm();
  const double crease_mm = std::abs(on_line_mm) - friction * held_mm;
  if (crease_mm < 1e-4 * here_.spacing_mm) return false;
  const Eigen::Vector3d crease_to_mm =
      lifted(place_mm_ + std::copysign(std::min(crease_mm, 0.8 * max_step_mm), on_line_mm) * line, nullptr);
  return gains(crease_to_mm) && try_step(field, crease_to_mm, nullptr);
}

}  // namespace prismesh::drivers::haptics
