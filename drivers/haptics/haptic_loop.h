// A tick of the haptic loop: pose in, proxy, forces, safety, force out. Pure: no ports, no clock, no allocation, no lock, no log. Its time
// doesn't depend on the mesh.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/haptic_pen/pen.h"
#include "drivers/haptics/forces.h"
#include "drivers/haptics/limits.h"
#include "drivers/haptics/proxy.h"
#include "drivers/haptics/resistance.h"
#include "drivers/haptics/safety.h"

namespace prismesh::drivers::haptics {

struct HapticTick {
  std::int64_t now_ns = 0;
  haptic_pen::PenReading pen;
  ForceSources sources;
  Feel feel;
  bool rearm = false;  ///< the user arms
};

struct HapticAnswer {
  haptic_pen::PenCommand command;  ///< to be sent in this tick
  SafetyOutput safety;
  ProxyContact contact;
  std::array<ForcePart, kForceKinds> parts;
  double stiffness_newton_m = 0;  ///< after the device's bound
};

/// Whether the line to the pen is at fault, for the safety.
bool is_line_fault(const haptic_pen::PenReading& pen);

class HapticLoop {
 public:
  /// The smaller of the device's and our own limits hold. `stored`: see SafetyRecord.
  HapticLoop(const HapticLimits& limits, const haptic_pen::PenLimits& device, const SafetyRecord& stored = {});
  HapticAnswer step(const HapticTick& tick);
  double max_newton() const { return max_newton_; }  ///< the smaller of both

 private:
  void take_pose(const haptic_pen::PenReading& pen);

  double max_stiffness_newton_m_;
  double max_newton_;
  Safety safety_;
  Proxy proxy_;
  Resistance resistance_;
  haptic_pen::PenPose pose_;
  PenMotion motion_;
};

}  // namespace prismesh::drivers::haptics
