// Hand, simulated pen, loop and field in virtual time, with a record for the checker.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "base/clock.h"
#include "drivers/haptic_pen/simulated_pen.h"
#include "drivers/haptics/haptic_loop.h"
#include "tests/drivers/haptics/field_rig.h"
#include "tests/drivers/haptics/force_checker.h"

namespace prismesh::drivers::haptics {

class HapticRig {
 public:
  static constexpr std::int64_t kTickNs = 1'000'000;

  HapticRig(const haptic_pen::SimulatedPenOptions& options, haptic_pen::HandSource hand, std::unique_ptr<HapticField> field_to_feel)
      : pen(options, std::move(hand)), loop({}, pen.limits()), field(std::move(field_to_feel)), checker(options.max_newton) {
    clock.advance_ns(1'000 * kTickNs);
  }

  HapticAnswer tick(std::int64_t after_ns = kTickNs) {
    clock.advance_ns(after_ns);
    const std::int64_t now = clock.now_ns();
    HapticTick input;
    input.now_ns = now;
    input.pen = pen.read(now);
    if (field_is_fresh) field->time_ns = now;
    input.sources = {.field = field.get(), .guides = guides.get(), .resistance = resistance.get()};
    if (fresh_slots && guides) guides->time_ns = now;
    if (fresh_slots && resistance) resistance->time_ns = now;
    input.feel = feel;
    input.rearm = std::exchange(rearm, false);
    HapticAnswer answer = loop.step(input);
    if (input.pen.fresh) pose = input.pen.pose;
    record(input, answer);
    pen.send(now, answer.command);
    return answer;
  }
  HapticAnswer run_ms(int ms) {
    HapticAnswer answer;
    for (int i = 0; i < ms; ++i) answer = tick();
    return answer;
  }
  HapticAnswer arm() {
    run_ms(20);
    rearm = true;
    tick();
    return run_ms(1100);
  }

  ManualClock clock;
  haptic_pen::SimulatedPen pen;
  HapticLoop loop;
  std::unique_ptr<HapticField> field;
  std::unique_ptr<HapticGuides> guides;
  std::unique_ptr<HapticResistance> resistance;
  Feel feel;
  bool rearm = false, field_is_fresh = true, fresh_slots = true;
  haptic_pen::PenPose pose;
  test::ForceChecker checker;
  bool kept = true;  ///< the checker found nothing

 private:
  void record(const HapticTick& input, const HapticAnswer& answer) {
    test::RecordedTick& tick = record_;
    tick.now_ns = input.now_ns;
    tick.measured_ns = pose.measured_ns;
    tick.ready = input.pen.phase == haptic_pen::PenPhase::ready;
    tick.io_error = input.pen.trouble == haptic_pen::PenTrouble::io_error;
    tick.lost_replies = input.pen.lost_replies;
    tick.rearm = input.rearm;
    tick.part_count = kForceKinds;
    for (int i = 0; i < 3; ++i) {
      tick.position_mm[i] = pose.position_mm[i];
      tick.force_newton[i] = answer.command.newton[i];
      for (std::size_t p = 0; p < kForceKinds; ++p) tick.parts[p].newton[i] = answer.parts[p].newton[i];
    }
    for (std::size_t p = 0; p < kForceKinds; ++p) {
      tick.parts[p].from_ns = answer.parts[p].from_ns;
      tick.parts[p].damping = answer.parts[p].damping;
    }
    tick.valid_until_ns = answer.command.valid_until_ns;
    kept = kept && checker.take(tick);
  }
  test::RecordedTick record_;
};

}  // namespace prismesh::drivers::haptics
