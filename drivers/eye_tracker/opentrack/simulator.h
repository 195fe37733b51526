// Simulates opentrack as seen on the wire: sends poses of a moving head as loopback datagrams, and repeats the last pose while the head is
// out of sight.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "drivers/eye_tracker/opentrack/datagram.h"
#include "drivers/eye_tracker/simulated_head.h"

namespace prismesh::drivers::eye_tracker::opentrack {

class OpentrackSimulator final : public TrackerSimulator {
 public:
  struct Options {
    double camera_hz = 30;  ///< rate of new poses
    double send_hz = 120;   ///< rate of datagrams; repeats the last pose between new ones
    double noise_mm = 1;
    double noise_degrees = 0.3;
    std::int64_t latency_ns = 20'000'000;  ///< from the head's position to the first datagram with it
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
    std::uint64_t seed = 1;
  };
  using Send = std::function<void(std::span<const std::byte> datagram)>;
  OpentrackSimulator(Send send, HeadSource head, const Options& options);

  void run_until(std::int64_t now_ns) override;
  std::uint64_t datagrams_sent() const { return sent_; }

 private:
  Pose measure(const SimulatedHead& head);

  Send send_;
  HeadSource head_;
  Options options_;
  std::mt19937_64 random_;
  bool started_ = false;
  std::int64_t start_ns_ = 0;
  std::uint64_t next_datagram_ = 0;
  std::int64_t next_picture_ = 0;
  Pose pose_;
  bool seen_ = false;  ///< a head was seen at least once
  std::uint64_t sent_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::opentrack
