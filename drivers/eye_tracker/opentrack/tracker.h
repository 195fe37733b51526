// Reads the head poses that opentrack sends to the loopback interface, so that a webcam can serve as the eye tracker. Sends nothing back.
// opentrack doesn't report a lost head: it repeats its last pose, about 250 times a second. A repeated pose is therefore not a new sample;
// the sample's age shows the loss.
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
    std::int64_t latency_ns = 20'000'000;  ///< from the head's position to its datagram
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
    std::int64_t silence_ns = 500'000'000;  ///< after so long without a datagram, the sender counts as silent
  };
  /// `port` must outlive this.
  OpentrackTracker(port::DatagramPort& port, const Options& options);

  /// Takes the newest of several datagrams. `resyncs`: how often the sender fell silent; `without_head`: repeated poses; `bytes_skipped`:
  /// bytes of datagrams that aren't poses.
  Polled poll(std::int64_t now_ns) override;
  bool synchronised() const override { return receiving_; }
  const LineCounts& counts() const override { return counts_; }

 private:
  void take(std::span<const std::byte> datagram, std::size_t full_length, Polled& polled);

  port::DatagramPort* port_;
  Options options_;
  LineCounts counts_;
  bool receiving_ = false;
  std::int64_t received_ns_ = 0;
  std::optional<Pose> last_;
};

}  // namespace prismesh::drivers::eye_tracker::opentrack
