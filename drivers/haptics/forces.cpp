#include "drivers/haptics/forces.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptics {
namespace {

Eigen::Vector3d vector_of(const double (&numbers)[3]) { return {numbers[0], numbers[1], numbers[2]}; }

Eigen::Vector3d pull_newton(const Eigen::Vector3d& pen_mm, const HapticGuides& guides, const Feel& feel) {
  double nearest_mm = feel.pull_reach_mm;
  Eigen::Vector3d way_mm = Eigen::Vector3d::Zero();
  for (std::int32_t i = 0; i < std::clamp(guides.count, 0, kMaxGuides); ++i) {
    const Eigen::Vector3d from = vector_of(guides.guides[i].from_mm), along = vector_of(guides.guides[i].to_mm) - from;
    const double square = along.squaredNorm();
    const double share = square > 0 ? std::clamp((pen_mm - from).dot(along) / square, 0.0, 1.0) : 0;
    const Eigen::Vector3d way = from + share * along - pen_mm;
    const double length_mm = way.norm();
    if (!(length_mm < nearest_mm)) continue;  // also for what isn't a number
    nearest_mm = length_mm;
    way_mm = way;
  }
  if (nearest_mm >= feel.pull_reach_mm || nearest_mm <= 0) return Eigen::Vector3d::Zero();
  const double share = nearest_mm / feel.pull_reach_mm;
  return 4 * feel.pull_newton * share * (1 - share) / nearest_mm * way_mm;
}

}  // namespace

std::array<ForcePart, kForceKinds> force_parts(const PenMotion& pen, const ProxyContact& contact, const ForceSources& sources,
                                               const Feel& feel) {
  std::array<ForcePart, kForceKinds> parts;
  const auto part = [&](ForceKind kind) -> ForcePart& { return parts[static_cast<std::size_t>(kind)]; };
  if (contact.touching && sources.field != nullptr) {
    const Eigen::Vector3d spring = feel.stiffness_newton_m * 1e-3 * (contact.proxy_mm - pen.position_mm);
    part(ForceKind::contact) = {spring.dot(contact.normal) * contact.normal, sources.field->time_ns, false};
    part(ForceKind::friction) = {spring - part(ForceKind::contact).newton, sources.field->time_ns, false};
  }
  part(ForceKind::damping) = {-feel.damping_newton_s_m * 1e-3 * pen.velocity_mm_s, 0, true};
  if (sources.guides != nullptr && sources.guides->placement == sources.placement)
    part(ForceKind::pull) = {pull_newton(pen.position_mm, *sources.guides, feel), sources.guides->time_ns, false};
  return parts;
}

}  // namespace prismesh::drivers::haptics
