// The forces of the pen: contact, friction, damping, a pull to a guide, a resistance. Each is a part that the safety sums.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "base/haptic_field.h"
#include "drivers/haptics/proxy.h"
#include "drivers/haptics/safety.h"

namespace prismesh::drivers::haptics {

/// How things feel. Starting values: nobody has felt them.
struct Feel {
  double stiffness_newton_m = 600;  ///< of contact; the loop lowers it to what the device allows (stiffness.h)
  double friction = 0.2;            ///< Coulomb's coefficient on shells
  double damping_newton_s_m = 0.3;  ///< in free space and in contact
  double pull_newton = 0.3;         ///< max. pull to a guide
  double pull_reach_mm = 4;         ///< beyond this a guide doesn't pull
  double max_resistance_newton = 2;
};

enum class ForceKind : std::uint8_t { contact, friction, damping, pull, resistance };
inline constexpr std::size_t kForceKinds = 5;

struct PenMotion {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
};

/// What the forces are made of. Slots may be null. Slots of another placement count as missing.
struct ForceSources {
  const HapticField* field = nullptr;
  const HapticGuides* guides = nullptr;
  const HapticResistance* resistance = nullptr;
  std::uint64_t placement = 0;
};

/// Returns a part for each ForceKind:
/// - contact and friction: stiffness * (proxy - pen), along the contact's normal and across it
/// - damping: against the velocity
/// - pull: toward the nearest guide; zero at the guide and at the reach, largest in the middle. A potential, so it gives back what it took
/// - resistance: zero, for it depends on the pen's way (resistance.h)
std::array<ForcePart, kForceKinds> force_parts(const PenMotion& pen, const ProxyContact& contact, const ForceSources& sources,
                                               const Feel& feel);

}  // namespace prismesh::drivers::haptics
