#include "drivers/eye_tracker/opentrack/simulator.h"

#include <cmath>
#include <utility>

namespace prismesh::drivers::eye_tracker::opentrack {
namespace {

constexpr double kSecondNs = 1e9;

}  // namespace

OpentrackSimulator::OpentrackSimulator(Send send, HeadSource head, const Options& options)
    : send_(std::move(send)), head_(std::move(head)), options_(options), random_(options.seed) {}

void OpentrackSimulator::run_until(std::int64_t now_ns) {
  if (!started_) {
    started_ = true;
    start_ns_ = now_ns;
  }
  const double now_s = static_cast<double>(now_ns - start_ns_) / kSecondNs;
  // After a long pause of the caller, skips the datagrams of that time.
  const auto due = static_cast<std::uint64_t>(std::max(0.0, now_s) * options_.send_hz);
  if (due > next_datagram_ + static_cast<std::uint64_t>(options_.send_hz)) next_datagram_ = due;
  for (; next_datagram_ <= due; ++next_datagram_) {
    const double sent_s = static_cast<double>(next_datagram_) / options_.send_hz;
    const auto picture = static_cast<std::int64_t>(std::floor(sent_s * options_.camera_hz + 1e-9));
    if (picture >= next_picture_) {
      next_picture_ = picture + 1;
      const double taken_s = static_cast<double>(picture) / options_.camera_hz - static_cast<double>(options_.latency_ns) / kSecondNs;
      if (const SimulatedHead head = head_(taken_s); head.visible) {
        pose_ = measure(head);
        seen_ = true;
      }
    }
    if (!seen_) continue;
    send_(encode(pose_));
    ++sent_;
  }
}

Pose OpentrackSimulator::measure(const SimulatedHead& head) {
  std::normal_distribution<double> noise(0, 1);
  Eigen::Vector3d position_mm = head.between_eyes_mm - options_.offset_mm;
  for (int axis = 0; axis < 3; ++axis) position_mm[axis] += options_.noise_mm * noise(random_);
  Pose pose = pose_for(position_mm, head.toward_right);
  pose.yaw_degrees += options_.noise_degrees * noise(random_);
  pose.pitch_degrees += options_.noise_degrees * noise(random_);
  pose.roll_degrees += options_.noise_degrees * noise(random_);
  return pose;
}

}  // namespace prismesh::drivers::eye_tracker::opentrack
