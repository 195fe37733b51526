// A Haply Inverse3 behind the interface of pens, by its maker's service.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "drivers/haptic_pen/inverse3/service_link.h"
#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptic_pen::inverse3 {

struct Inverse3Options {
  double force_scale = 1;           ///< true newtons for one that was asked for, from weighing
  double damping_newton_s_m = 0.5;  ///< the device's own: a guess
  double friction_newton = 0.1;     ///< the same
};

PenLimits inverse3_limits(const Inverse3Options& options);

class Inverse3Pen final : public HapticPen {
 public:
  /// `link` must outlive the pen.
  Inverse3Pen(ServiceLink& link, const Inverse3Options& options) : link_(link), options_(options), limits_(inverse3_limits(options)) {}

  /// A pose has the time in the middle between its question and its answer. The first comes after the first `send`.
  PenReading read(std::int64_t now_ns) override;
  void send(std::int64_t now_ns, const PenCommand& command) override;
  const PenLimits& limits() const override { return limits_; }
  bool gone() const override { return link_.end() != LinkEnd::none; }
  /// The thread has handled nothing for 10 ms, and something waits.
  bool is_stuck(std::int64_t now_ns) override;
  std::string advice() const override;
  std::int64_t round_trip_ns() const override { return round_trip_ns_; }

 private:
  ServiceLink& link_;
  Inverse3Options options_;
  PenLimits limits_;
  std::atomic<bool> answered_ = false, ready_ = false;
  std::uint32_t buttons_ = 0;
  std::uint64_t put_ = 0, handled_ = 0;
  std::int64_t moved_ns_ = 0, round_trip_ns_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen::inverse3
