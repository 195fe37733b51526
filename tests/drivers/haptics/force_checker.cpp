#include "tests/drivers/haptics/force_checker.h"

#include <algorithm>
#include <cmath>

namespace prismesh::test {
namespace {

constexpr double kTiny = 1e-9;

double length3(const double v[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool real3(const double v[3]) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

}  // namespace

bool ForceChecker::broken(const RecordedTick& tick, const char* promise) {
  fault_ = std::string(promise) + " at tick " + std::to_string(figures_.ticks) + ", " +
           std::to_string(static_cast<double>(tick.now_ns) * 1e-6) + " ms, force " + std::to_string(tick.force_newton[0]) + " " +
           std::to_string(tick.force_newton[1]) + " " + std::to_string(tick.force_newton[2]);
  return false;
}

/// A jump, a wrong time or too much speed of a new pose. Also keeps the places and the account of work.
bool ForceChecker::faulty_motion(const RecordedTick& tick) {
  if (tick.measured_ns == 0 || !real3(tick.position_mm)) return false;
  if (tick.measured_ns > tick.now_ns) return true;
  if (places_.empty()) {
    places_.push_back({tick.measured_ns, {tick.position_mm[0], tick.position_mm[1], tick.position_mm[2]}});
    return false;
  }
  const Place& last = places_.back();
  double moved[3];
  for (int i = 0; i < 3; ++i) moved[i] = tick.position_mm[i] - last.mm[i];
  const std::int64_t between = tick.measured_ns - last.ns;
  if (between == 0) return length3(moved) != 0;
  const bool jump = between < 0 || length3(moved) > 1.0 + 1.5e-6 * static_cast<double>(between);
  if (jump) {
    places_.clear();
  } else {
    add_work(tick, moved);
  }
  places_.push_back({tick.measured_ns, {tick.position_mm[0], tick.position_mm[1], tick.position_mm[2]}});
  if (jump) return true;
  // Speed over the last 4 ms.
  if (places_.size() > 64) places_.erase(places_.begin(), places_.begin() + 32);
  std::size_t from = places_.size() - 1;
  while (from > 0 && tick.measured_ns - places_[from].ns < 4'000'000) --from;
  double way[3];
  for (int i = 0; i < 3; ++i) way[i] = tick.position_mm[i] - places_[from].mm[i];
  const double ms = std::max(4.0, static_cast<double>(tick.measured_ns - places_[from].ns) * 1e-6);
  return length3(way) / ms > 1.5 + kTiny;  // mm per ms
}

/// Work on the way between two poses: of the last force that was sent, or, where that command ended before, on as much of the way as the
/// hand can have gone until then.
void ForceChecker::add_work(const RecordedTick& tick, const double moved_mm[3]) {
  double joule = dot3(last_force_, moved_mm) * 1e-3;
  if (tick.now_ns > last_valid_until_ns_) {
    const double reach = 1.0 + 1.5e-6 * static_cast<double>(last_valid_until_ns_ - places_.back().ns);
    joule = std::max(0.0, joule * std::min(1.0, reach / std::max(length3(moved_mm), 1e-300)));
  }
  net_joule_ += joule;
  if (joule > 0) {
    figures_.given_joule += joule;
    const double own = std::min(credit_joule_, joule);
    credit_joule_ -= own;
    spare_joule_ -= joule - own;
  } else {
    figures_.taken_joule -= joule;
    credit_joule_ = std::min(0.064, credit_joule_ - joule);
  }
  figures_.min_spare_joule = std::min(figures_.min_spare_joule, spare_joule_);
}

/// The part of the force that is no fall of the last one may not rise by more than 200 N/s, counted for at most 2 ms.
bool ForceChecker::check_rise(const RecordedTick& tick) {
  double before[3] = {last_force_[0], last_force_[1], last_force_[2]};
  if (tick.now_ns > last_valid_until_ns_) before[0] = before[1] = before[2] = 0;
  const double square = dot3(before, before);
  const double share = square > 0 ? std::min(1.0, std::max(0.0, dot3(before, tick.force_newton) / square)) : 0;
  double rise[3];
  for (int i = 0; i < 3; ++i) rise[i] = tick.force_newton[i] - share * before[i];
  const double ms = std::min(2.0, static_cast<double>(tick.now_ns - last_ns_) * 1e-6);
  return length3(rise) <= 0.2 * ms + 1e-7;
}

/// The length of what the loop asked for, without parts that may not act.
double ForceChecker::wanted_newton(const RecordedTick& tick) {
  const bool late = any_ && tick.now_ns - last_ns_ > 3'000'000;
  const bool old_pose = !places_.empty() && tick.now_ns - places_.back().ns > 4'000'000;
  const bool arming = !may_push_;
  double wanted[3] = {};
  for (std::uint32_t p = 0; p < tick.part_count; ++p) {
    const RecordedPart& part = tick.parts[p];
    if (!arming && (late || old_pose) && !part.damping) continue;
    double share = 1;
    if (part.from_ns != 0) {
      const double age_ms = static_cast<double>(tick.now_ns - part.from_ns) * 1e-6;
      share = age_ms < -1 ? 0 : age_ms <= 100 ? 1 : age_ms >= 150 ? 0 : (150 - age_ms) / 50;
    }
    if (share < 1 && may_push_) ++figures_.faded;
    for (int i = 0; i < 3; ++i) wanted[i] += share * part.newton[i];
  }
  if (late && may_push_) ++figures_.late;
  return length3(wanted);
}

bool ForceChecker::take(const RecordedTick& tick) {
  ++figures_.ticks;
  const double seconds = any_ ? std::max(0.0, static_cast<double>(tick.now_ns - last_ns_) * 1e-9) : 0.001;
  if (!real3(tick.force_newton)) return broken(tick, "a force isn't finite");
  const double force = length3(tick.force_newton);
  figures_.max_newton = std::max(figures_.max_newton, force);
  if (force > 0) ++figures_.with_force;
  if (force > 8 + kTiny) return broken(tick, "a force is over 8 N");
  for (const double axis : tick.force_newton)
    if (std::abs(axis) > max_axis_ + kTiny) return broken(tick, "a force is over the motor's limit");
  if (tick.valid_until_ns > tick.now_ns + 3'000'000) return broken(tick, "a command holds for more than 3 ms");

  bool fault = tick.io_error || tick.lost_replies > 0 || !real3(tick.position_mm);
  for (std::uint32_t p = 0; p < tick.part_count; ++p) fault = fault || !real3(tick.parts[p].newton);
  const bool back = any_ && tick.now_ns < last_ns_;
  if (real3(tick.position_mm) && !back &&
      !std::any_of(tick.parts.begin(), tick.parts.begin() + tick.part_count, [](const RecordedPart& part) { return !real3(part.newton); }))
    fault = faulty_motion(tick) || fault;
  fault = fault || back || (any_ && tick.now_ns - last_ns_ > 11'000'000);
  fault = fault || places_.empty() || tick.now_ns - places_.back().ns > 10'000'000;

  spare_joule_ = std::min(0.020, spare_joule_ + 0.050 * seconds);
  since_start_s_ += seconds;
  if (spare_joule_ < -kTiny) return broken(tick, "the hand got more work than it may");
  const double line = net_joule_ - 0.050 * since_start_s_;
  min_line_joule_ = std::min(min_line_joule_, line);
  if (line > 0.020 + kTiny) return broken(tick, "the hand got more than 20 mJ and 50 mW beyond all that it put in");
  if (line - min_line_joule_ > 0.020 + 0.064 + kTiny) return broken(tick, "the hand got too much work at once");

  // The rise of the button gives the force back, unless something is wrong in this tick or the pen touches something.
  if (fault || !tick.ready) {
    if (may_push_) ++figures_.latches;
    may_push_ = false;
  } else if (tick.rearm && !last_rearm_ && !may_push_ && wanted_newton(tick) <= 0.4) {
    may_push_ = true;
    armed_ns_ = tick.now_ns;
    ++figures_.arms;
  }
  if (force > 0) {
    if (!may_push_) return broken(tick, "force although disarmed or latched");
    const double since = static_cast<double>(tick.now_ns - armed_ns_) * 1e-9;
    if (force > std::min(8.0, 0.4 + 7.6 * since) + kTiny) return broken(tick, "force rises too early after arming");
    if (!check_rise(tick)) return broken(tick, "a force rises too fast");
  }
  if (force > 0 && force > wanted_newton(tick) + 1e-6) return broken(tick, "a force is longer than what is wanted");
  any_ = true;
  last_ns_ = tick.now_ns;
  last_rearm_ = tick.rearm;
  for (int i = 0; i < 3; ++i) last_force_[i] = tick.force_newton[i];
  last_valid_until_ns_ = tick.valid_until_ns;
  return true;
}

}  // namespace prismesh::test
