// A tracker on a cable in memory with a simulated device at the other end, and a loop that polls it 200 times per second of virtual time.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "drivers/eye_tracker/dynasight/simulator.h"
#include "drivers/eye_tracker/dynasight/tracker.h"
#include "drivers/port/memory_line.h"

namespace prismesh::drivers::eye_tracker::dynasight {

inline constexpr std::int64_t kMs = 1'000'000;

inline port::MemoryLineSettings line_of(int baud) {
  port::MemoryLineSettings settings;
  settings.host_baud = settings.device_baud = baud;
  return settings;
}

/// Moves 20 cm to either side every 5 seconds, with some lean; max. 250 mm/s.
inline SimulatedHead swaying_head(double seconds) {
  SimulatedHead head;
  head.between_eyes_mm = {200 * std::sin(2 * 3.14159265 * seconds / 5), 30, 650 + 50 * std::cos(2 * 3.14159265 * seconds / 7)};
  return head;
}

class TrackerStation {
 public:
  using Device = DynasightSimulator::Options;
  using Driver = DynasightTracker::Options;

  explicit TrackerStation(const Device& device = {}, const Driver& driver = {}, HeadSource head = swaying_head)
      : line_(clock_, line_of(device.baud)), head_(head), device_(line_.device(), std::move(head), device), driver_(driver) {
    device_.run_until(clock_.now_ns());
    plug_in();
  }

  /// Returns the samples that the loop receives in that time.
  std::vector<HeadSample> run(double seconds) {
    std::vector<HeadSample> samples;
    for (const std::int64_t end = clock_.now_ns() + static_cast<std::int64_t>(seconds * 1e9); clock_.now_ns() < end;) {
      for (int i = 0; i < 20; ++i) {
        clock_.advance_ns(kMs / 4);
        device_.run_until(clock_.now_ns());
      }
      poll(samples);
    }
    return samples;
  }
  /// Advances the device's time while the loop doesn't poll.
  void stall(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 4000); ++i) {
      clock_.advance_ns(kMs / 4);
      device_.run_until(clock_.now_ns());
    }
  }
  void poll(std::vector<HeadSample>& samples) {
    if (!tracker_) return;
    const EyeTracker::Polled polled = tracker_->poll(clock_.now_ns());
    if (polled.fresh) samples.push_back(polled.sample);
    if (polled.status != port::PortStatus::gone) return;
    tracker_.reset();
    port_.reset();
    gone_ns_ = clock_.now_ns();
  }
  void plug_in() {
    line_.plug_in();
    port_ = std::move(*line_.open_host());
    tracker_ = std::make_unique<DynasightTracker>(*port_, driver_);
  }

  Eigen::Vector3d truth_mm(std::int64_t time_ns) const { return head_(static_cast<double>(time_ns) * 1e-9).between_eyes_mm; }
  /// Max. distance between the samples and the head's true positions at their times.
  double worst_error_mm(const std::vector<HeadSample>& samples) const {
    double worst = 0;
    for (const HeadSample& sample : samples) worst = std::max(worst, (sample.between_eyes_mm - truth_mm(sample.measured_ns)).norm());
    return worst;
  }

  ManualClock& clock() { return clock_; }
  port::MemoryLine& line() { return line_; }
  DynasightSimulator& device() { return device_; }
  DynasightTracker* tracker() { return tracker_.get(); }  ///< null after its port is gone
  std::int64_t gone_ns() const { return gone_ns_; }

 private:
  ManualClock clock_;
  port::MemoryLine line_;
  HeadSource head_;
  DynasightSimulator device_;
  Driver driver_;
  std::unique_ptr<port::BytePort> port_;
  std::unique_ptr<DynasightTracker> tracker_;
  std::int64_t gone_ns_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::dynasight
