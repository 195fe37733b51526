// A pen behind a line of frames (frame.h).
#pragma once

#include <atomic>
#include <cstdint>

#include "drivers/haptic_pen/framed/frame.h"
#include "drivers/haptic_pen/pen.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::haptic_pen::framed {

class FramedPen final : public HapticPen {
 public:
  /// `line` must outlive the pen. `limits`: of the device behind it; its delay must include the line's.
  FramedPen(port::BytePort& line, const PenLimits& limits) : line_(line), limits_(limits) {}

  /// A pose has the time of this call: the device's clock isn't ours.
  PenReading read(std::int64_t now_ns) override;
  void send(std::int64_t now_ns, const PenCommand& command) override;
  const PenLimits& limits() const override { return limits_; }

  bool gone() const override { return gone_; }
  std::int64_t round_trip_ns() const override { return round_trip_ns_; }
  std::uint64_t lost_frames() const { return lost_frames_; }

 private:
  void take(const PoseFrame& frame, std::int64_t now_ns, PenReading& reading);

  port::BytePort& line_;
  PenLimits limits_;
  FrameFinder finder_;
  PenPhase phase_ = PenPhase::absent;
  std::uint32_t buttons_ = 0;
  std::atomic<bool> gone_ = false;  ///< read by the thread that opened the line, too
  bool refused_ = false, started_ = false;
  std::uint8_t number_ = 0, pose_number_ = 0, answered_ = 0;
  std::array<std::int64_t, 256> sent_ns_{};
  std::int64_t round_trip_ns_ = 0;
  std::uint64_t lost_frames_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen::framed
