// The pen's loop with its line and device in virtual time.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "base/clock.h"
#include "daemon/deviced/pen/line_guard.h"
#include "daemon/deviced/pen/pen_loop.h"
#include "drivers/haptic_pen/framed/framed_pen.h"
#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/port/memory_line.h"

namespace prismesh::deviced::pen {

class PenLoopRig {
 public:
  explicit PenLoopRig(drivers::haptics::SafetyRecord stored = {})
      : line(clock, {.host_baud = 4'000'000, .device_baud = 4'000'000}),
        port(line.open_host().value()),
        guarded(*port, guard),
        device(
            line.device(), {}, [](double s) { return hand(s); },
            [this](std::int64_t, const drivers::haptic_pen::framed::ForceFrame& frame) { seen.push_back(frame); }),
        pen(guarded, drivers::haptic_pen::framed::simulated_limits({})),
        page(ipc::PenPage::create().value()),
        loop({}, pen, fields, guard, page, stored, {}) {
    clock.advance_ns(1'000'000'000);
    seen.reserve(100'000);
  }
  static drivers::haptic_pen::SimulatedHand hand(double seconds) {
    drivers::haptic_pen::SimulatedHand hand;
    hand.goal_mm = {20 * std::sin(9 * seconds), 0, 20 * std::cos(9 * seconds)};
    return hand;
  }
  void tick(std::int64_t after_ns = 1'000'000) {
    for (int part = 0; part < 4; ++part) {
      clock.advance_ns(after_ns / 4);
      device.step(clock.now_ns());
    }
    loop.tick(clock.now_ns());
  }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) tick();
  }
  void arm() {
    run_ms(20);
    loop.send(RequestArm{});
    run_ms(200);
  }
  ipc::PenState state() { return page.state(); }
  /// Whether all frames from this one on were zero; false if there were none.
  bool zeros_from(std::size_t from) const {
    for (std::size_t i = from; i < seen.size(); ++i)
      if (!seen[i].newton.isZero(0)) return false;
    return seen.size() > from;
  }

  ManualClock clock;
  drivers::port::MemoryLine line;
  std::unique_ptr<drivers::port::BytePort> port;
  GuardPage guard;
  GuardedPort guarded;
  std::vector<drivers::haptic_pen::framed::ForceFrame> seen;
  drivers::haptic_pen::framed::SimulatedDevice device;
  drivers::haptic_pen::framed::FramedPen pen;
  FieldReader fields;
  ipc::PenPage page;
  PenLoop loop;
};

}  // namespace prismesh::deviced::pen
