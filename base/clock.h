// Clocks as arguments, so that tests control the time of a loop.
#pragma once

#include <cmath>
#include <cstdint>

namespace prismesh {

/// Converts a setting in milliseconds.
inline std::int64_t nanoseconds(double milliseconds) { return std::llround(milliseconds * 1e6); }

class Clock {
 public:
  virtual ~Clock() = default;
  /// Nanoseconds since an arbitrary fixed start, never going back.
  virtual std::int64_t now_ns() = 0;
};

/// CLOCK_MONOTONIC: the same epoch in every process of a machine.
class MonotonicClock final : public Clock {
 public:
  std::int64_t now_ns() override;
};

/// Stands still until a test moves it.
class ManualClock final : public Clock {
 public:
  std::int64_t now_ns() override { return now_ns_; }
  void advance_ns(std::int64_t by) { now_ns_ += by; }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace prismesh
