// The line of a weighing: what was sent last, and whether the guard had to end it.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "daemon/deviced/pen/guard_page.h"
#include "drivers/haptic_pen/pen.h"

namespace prismesh::deviced::pen {

/// Neither blocks nor allocates. For the weighing's thread.
class WeighingLine {
 public:
  WeighingLine(drivers::haptic_pen::HapticPen& pen, GuardPage& guard) : pen_(pen), guard_(guard) {}

  /// Sends a force, newtons; after the guard had to end one, only zero. Where the guard took the line from a program that asked for no
  /// force, it gets it back and the weighing goes on. Returns whether a force was ended.
  bool send(std::int64_t now_ns, const Eigen::Vector3d& newton);

 private:
  drivers::haptic_pen::HapticPen& pen_;
  GuardPage& guard_;
  bool forces_ = false;  ///< the last send asked for a force
  bool ended_ = false;
};

}  // namespace prismesh::deviced::pen
