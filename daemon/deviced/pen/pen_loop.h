// The tick of the pen's process: reads the pen and the newest field, computes the force, sends it, publishes. Time and devices are passed
// in. A tick doesn't allocate, lock, log or block.
#pragma once

#include <cstdint>
#include <variant>

#include "base/ring.h"
#include "daemon/deviced/pen/field_reader.h"
#include "daemon/deviced/pen/guard_page.h"
#include "drivers/haptic_pen/pen.h"
#include "drivers/haptics/haptic_loop.h"
#include "ipc/pen/page.h"

namespace prismesh::deviced::pen {

// Commands from the main thread to the loop.
struct RequestArm {};
struct RequestDisarm {};
struct UseFeel {
  drivers::haptics::Feel feel;
};
using PenCommandOfMain = std::variant<RequestArm, RequestDisarm, UseFeel>;

class PenLoop {
 public:
  /// All must outlive the loop. `stored`: see SafetyRecord. `arms_answered`: of the loop before this one.
  PenLoop(const drivers::haptics::HapticLimits& limits, drivers::haptic_pen::HapticPen& pen, FieldReader& fields, GuardPage& guard,
          ipc::PenPage& page, const drivers::haptics::SafetyRecord& stored, const drivers::haptics::Feel& feel,
          std::uint64_t arms_answered = 0);

  /// Called once a period.
  void tick(std::int64_t now_ns);
  /// Called instead of `tick` before the loop ends: sends zero.
  void wind_down(std::int64_t now_ns);

  // Called from one other thread.
  /// Returns false if the ring is full.
  bool send(const PenCommandOfMain& command) { return commands_.push(command); }
  /// What has to be stored.
  drivers::haptics::SafetyRecord record() const { return record_.read().value_or(drivers::haptics::SafetyRecord{}); }

 private:
  void take_commands(drivers::haptics::HapticTick& tick);
  void publish(std::int64_t now_ns, const drivers::haptics::HapticTick& tick, const drivers::haptics::HapticAnswer& answer);
  void keep(const drivers::haptics::HapticTick& tick, const drivers::haptics::HapticAnswer& answer);

  drivers::haptic_pen::HapticPen& pen_;
  FieldReader& fields_;
  GuardPage& guard_;
  ipc::PenPage& page_;
  drivers::haptics::HapticLoop loop_;
  drivers::haptics::Feel feel_;
  ipc::PenState state_;
  Ring<PenCommandOfMain, 64> commands_;
  ipc::SeqlockSlot<drivers::haptics::SafetyRecord> record_;
  bool arming_ = false;
  drivers::haptics::SafetyRecord stored_;
  bool begins_ = true;  ///< no tick yet
};

}  // namespace prismesh::deviced::pen
