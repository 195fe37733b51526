// Reads head poses that opentrack sends to this machine's loopback interface, so that a webcam can serve as the eye tracker. Nothing is
// sent back. opentrack knows no "lost": it repeats its last pose, some 250 times a second. A repeated pose is therefore no new sample, and
// its age tells.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "drivers/eye_tracker/eye_tracker.h"
#include "drivers/eye_tracker/opentrack/datagram.h"
#include "drivers/port/udp_port.h"

namespace prismesh::drivers::eye_tracker::opentrack {

class OpentrackTracker final : public EyeTracker {
 public:
  struct Options {
    std::int64_t latency_ns = 20'000'000;  ///< from the head being there to its datagram
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
    std::int64_t silence_ns = 500'000'000;  ///< no datagram for this long: nobody sends
  };
  /// `port` must outlive this.
  OpentrackTracker(port::DatagramPort& port, const Options& options);

  /// Of several datagrams the newest counts. `resyncs`: times that the sender fell silent; `without_head`: repeated poses; `bytes_skipped`:
  /// of datagrams that are no pose.
  Polled poll(std::int64_t now_ns) override;
  bool synchronised() const override { return heard_; }
  const LineCounts& counts() const override { return counts_; }

 private:
  void take(std::span<const std::byte> datagram, std::size_t full_length, Polled& polled);

  port::DatagramPort* port_;
  Options options_;
  LineCounts counts_;
  bool heard_ = false;
  std::int64_t heard_ns_ = 0;
  std::optional<Pose> last_;
};

}  // namespace prismesh::drivers::eye_tracker::opentrack
