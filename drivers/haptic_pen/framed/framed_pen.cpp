#include "drivers/haptic_pen/framed/framed_pen.h"

#include <algorithm>

namespace prismesh::drivers::haptic_pen::framed {

using port::PortCount;
using port::PortStatus;

PenReading FramedPen::read(std::int64_t now_ns) {
  PenReading reading;
  const std::uint64_t skipped = finder_.skipped();
  // Twice: the line may hold more than the finder. What is left then is read in the next tick.
  for (int turn = 0; turn < 2 && !gone_; ++turn) {
    const PortCount got = line_.read(finder_.space());
    gone_ = got.status == PortStatus::gone;
    finder_.received(got.bytes);
    while (const auto bytes = finder_.next()) {
      if (const auto frame = decode_pose(*bytes))
        take(*frame, now_ns, reading);
      else
        reading.trouble = PenTrouble::bad_reply;
    }
    if (got.bytes == 0) break;
  }
  // Before the first frame the line may hold the end of an older one.
  if (started_ && finder_.skipped() != skipped) reading.trouble = PenTrouble::bad_reply;
  if (gone_ || refused_) reading.trouble = PenTrouble::io_error;
  refused_ = false;
  reading.phase = gone_ ? PenPhase::absent : phase_;
  reading.buttons = buttons_;
  return reading;
}

void FramedPen::take(const PoseFrame& frame, std::int64_t now_ns, PenReading& reading) {
  // A pose that is lost is no lost reply: the next one comes by itself, and old poses are found by their time.
  if (started_) lost_frames_ += static_cast<std::uint8_t>(frame.number - pose_number_ - 1);
  started_ = true;
  pose_number_ = frame.number;
  phase_ = frame.phase;
  buttons_ = frame.buttons;
  if (frame.answers != answered_ && sent_ns_[frame.answers] != 0) round_trip_ns_ = now_ns - sent_ns_[frame.answers];
  answered_ = frame.answers;
  ++reading.replies;
  reading.fresh = true;
  reading.pose.measured_ns = now_ns;
  reading.pose.position_mm = frame.position_mm;
}

void FramedPen::send(std::int64_t now_ns, const PenCommand& command) {
  if (gone_) return;
  ForceFrame frame;
  frame.number = ++number_;
  frame.newton = command.newton;
  frame.valid_ms = static_cast<std::uint16_t>(std::clamp<std::int64_t>((command.valid_until_ns - now_ns) / 1'000'000, 0, 1000));
  sent_ns_[frame.number] = now_ns;
  const FrameBytes bytes = encode(frame);
  const PortCount put = line_.write(bytes);
  gone_ = put.status == PortStatus::gone;
  refused_ = put.bytes != bytes.size();
}

}  // namespace prismesh::drivers::haptic_pen::framed
