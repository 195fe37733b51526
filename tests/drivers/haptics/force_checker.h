// Checks the record of a haptic loop against its promises. Shares no code with the safety module: the promises are written here a second
// time, as numbers of the documentation (docs/haptics.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/drivers/haptics/force_record.h"

namespace prismesh::test {

class ForceChecker {
 public:
  /// `max_axis_newton`: the device's motors.
  explicit ForceChecker(double max_axis_newton) : max_axis_(max_axis_newton) {}
  /// Takes the next tick of the record. Returns false and sets `fault()` when a promise is broken.
  bool take(const RecordedTick& tick);
  const std::string& fault() const { return fault_; }

  struct Figures {
    std::uint64_t ticks = 0, with_force = 0, latches = 0, arms = 0, late = 0, faded = 0;
    double max_newton = 0;
    double min_spare_joule = 1;  ///< how close the work came to its limit
    double given_joule = 0;      ///< work put into the hand
    double taken_joule = 0;
  };
  const Figures& figures() const { return figures_; }

 private:
  struct Place {
    std::int64_t ns = 0;
    double mm[3] = {};
  };
  bool broken(const RecordedTick& tick, const char* promise);
  bool faulty_motion(const RecordedTick& tick);
  void add_work(const RecordedTick& tick, const double moved_mm[3]);
  bool check_rise(const RecordedTick& tick);
  double wanted_newton(const RecordedTick& tick);

  double max_axis_;
  std::string fault_;
  Figures figures_;
  bool any_ = false;
  std::int64_t last_ns_ = 0;
  bool last_rearm_ = true;
  double last_force_[3] = {};
  std::int64_t last_valid_until_ns_ = 0;
  bool may_push_ = false;  ///< armed since the last fault
  std::int64_t armed_ns_ = 0;
  std::vector<Place> places_;  ///< poses of the last milliseconds
  double spare_joule_ = 0.020, credit_joule_ = 0;
  double net_joule_ = 0, min_line_joule_ = 0, since_start_s_ = 0;
};

}  // namespace prismesh::test
