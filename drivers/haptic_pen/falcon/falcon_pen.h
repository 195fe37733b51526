// A Novint Falcon behind the interface of pens: boots it, waits until it was homed by hand, then exchanges a packet a tick.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "drivers/haptic_pen/falcon/boot.h"
#include "drivers/haptic_pen/falcon/kinematics.h"
#include "drivers/haptic_pen/falcon/packet.h"
#include "drivers/haptic_pen/pen.h"
#include "drivers/port/usb_port.h"

namespace prismesh::drivers::haptic_pen::falcon {

struct FalconOptions {
  std::vector<std::byte> firmware;  ///< empty: none was given
  double force_scale = 1;           ///< of the device's true force, from weighing: true newtons for one that was asked for
  double damping_newton_s_m = 0.5;  ///< the device's own: a guess
  double friction_newton = 0.1;     ///< the same
};

/// What libusb has to look for.
port::UsbWanted falcon_wanted();
PenLimits falcon_limits(const FalconOptions& options);
/// Units of the motors for a newton metre at an arm; and the largest that are sent. libnifalcon calls its own limit a rather random choice:
/// no newton is verified until the device was weighed.
inline constexpr double kUnitsPerNewtonMetre = 10'000;
inline constexpr double kMaxUnits = 4096;

/// A packet without force, for whoever holds the line.
PacketBytes zero_packet();

class FalconPen final : public HapticPen {
 public:
  /// `port` must outlive the pen.
  FalconPen(port::UsbPort& port, FalconOptions options);

  /// A pose has the time in the middle between its question and its answer.
  PenReading read(std::int64_t now_ns) override;
  void send(std::int64_t now_ns, const PenCommand& command) override;
  const PenLimits& limits() const override { return limits_; }
  bool gone() const override { return gone_; }
  /// The bus has finished nothing for 10 ms, and something waits.
  bool is_stuck(std::int64_t now_ns) override;
  std::string advice() const override;
  std::int64_t round_trip_ns() const override { return round_trip_ns_; }

 private:
  void take(const PosePacket& packet, std::int64_t now_ns, PenReading& reading);
  std::array<std::int16_t, 3> motor_units(const Eigen::Vector3d& newton) const;

  port::UsbPort& port_;
  FalconOptions options_;
  PenLimits limits_;
  Boot boot_;
  PacketFinder finder_;
  std::atomic<bool> gone_ = false;
  std::atomic<std::uint8_t> homed_ = 0;
  bool refused_ = false, answered_ = false, placed_ = false, sent_force_ = false;
  GripPlace place_;
  std::uint32_t buttons_ = 0;
  std::array<std::int64_t, 8> asked_ns_{};  ///< a ring of the questions without an answer
  std::size_t asked_begin_ = 0, asked_count_ = 0;
  std::uint64_t finished_ = 0;
  std::int64_t moved_ns_ = 0;  ///< when the bus has last finished something, or had nothing to do
  std::int64_t round_trip_ns_ = 0, resync_until_ns_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen::falcon
