// The device loop in virtual time: the state page while devices start, work, are lost and return.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/deviced/loop_rig.h"
#include "tests/drivers/port/allocations.h"

namespace prismesh::deviced {
namespace {

using drivers::eye_tracker::SimulatedHead;
using drivers::prism_servo::MaskPhase;
using ipc::EyesPhase;
using ::testing::ElementsAre;

std::vector<EyesPhase> eyes_phases(const std::vector<LoopEvent>& events) {
  std::vector<EyesPhase> phases;
  for (const LoopEvent& event : events)
    if (const auto* changed = std::get_if<EyesChanged>(&event)) phases.push_back(changed->phase);
  return phases;
}
std::vector<MaskPhase> mask_phases(const std::vector<LoopEvent>& events) {
  std::vector<MaskPhase> phases;
  for (const LoopEvent& event : events)
    if (const auto* changed = std::get_if<MaskChanged>(&event)) phases.push_back(changed->phase);
  return phases;
}

TEST(DeviceLoop, publishes_the_phases_of_starting_up) {
  LoopRig rig;
  EXPECT_EQ(rig.eyes().phase, EyesPhase::none) << "before the first tick";
  rig.tick();
  EXPECT_EQ(rig.eyes().phase, EyesPhase::silent);
  EXPECT_EQ(rig.mask().phase, MaskPhase::absent);
  EXPECT_FALSE(rig.mask().stereo_allowed);
  const std::int64_t ms = rig.run_until([&] { return rig.tracking() && rig.following(); });
  EXPECT_GE(ms, 0) << rig.state();
  EXPECT_LE(ms, 3000);
  const std::vector<LoopEvent> events = rig.events();
  EXPECT_THAT(eyes_phases(events), ElementsAre(EyesPhase::silent, EyesPhase::searching, EyesPhase::tracking));
  EXPECT_THAT(mask_phases(events), ElementsAre(MaskPhase::homing, MaskPhase::following));
}

TEST(DeviceLoop, publishes_the_head_and_the_mask_that_follows) {
  RigOptions options;
  LoopRig rig(options);
  rig.start();
  rig.run_for_ms(500);
  double worst_eyes_mm = 0, worst_mask_mm = 0, youngest_ms = 1000, oldest_ms = 0;
  rig.after_tick = [&] {
    youngest_ms = std::min(youngest_ms, rig.eyes_age_ms());
    oldest_ms = std::max(oldest_ms, rig.eyes_age_ms());
    if (!rig.following()) return;  // during a move back
    const std::int64_t now = rig.clock.now_ns();
    // The simulator's time starts with its first step.
    const Eigen::Vector3d truth = options.head(static_cast<double>(now - 1'001 * kMs) * 1e-9).between_eyes_mm;
    const Eigen::Vector3d predicted = drivers::eye_tracker::predict(rig.eyes().head(), now);
    worst_eyes_mm = std::max(worst_eyes_mm, (predicted - truth).head<2>().norm());
    const double wanted =
        drivers::display::mask_position_mm(options.loop.optics, truth) - rig.mask().half_periods * options.loop.optics.mask_pitch_mm() / 2;
    worst_mask_mm = std::max(worst_mask_mm, std::abs(rig.servo.mask_mm() - wanted));
  };
  rig.run_for_ms(12'000);
  EXPECT_LE(worst_eyes_mm, 8);
  EXPECT_GE(youngest_ms, 18) << "a measurement is as old as the tracker is slow";
  EXPECT_LE(oldest_ms, 45) << "and one comes every 17 ms";
  EXPECT_LE(worst_mask_mm, 0.05) << "0.0044 mm of mask a millimetre of head, backlash, lag";
  EXPECT_GE(rig.eyes().records, 600u);
  EXPECT_EQ(rig.eyes().resyncs, 0u);
  EXPECT_EQ(rig.eyes().times_lost, 0u);
}

TEST(DeviceLoop, when_the_head_leaves_the_mask_freezes_and_parks) {
  bool there = true;
  RigOptions options;
  options.head = [&](double) {
    SimulatedHead head;
    head.between_eyes_mm = {40, 0, 650};
    head.visible = there;
    return head;
  };
  LoopRig rig(options);
  rig.start();
  rig.events();
  there = false;
  const std::int64_t searching = rig.run_until([&] { return rig.eyes().phase == EyesPhase::searching; });
  EXPECT_GE(searching, 50);
  EXPECT_LE(searching, 150) << "the newest measurement is older than eyes_lost_ns";
  rig.tick();
  EXPECT_FALSE(rig.mask().stereo_allowed);
  ASSERT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::parked; }, 2000), 0) << rig.state();
  EXPECT_EQ(rig.eyes().times_lost, 1u);
  EXPECT_THAT(mask_phases(rig.events()), ElementsAre(MaskPhase::frozen, MaskPhase::parking, MaskPhase::parked));

  there = true;
  const std::int64_t back = rig.run_until([&] { return rig.tracking() && rig.following(); });
  EXPECT_GE(back, 0) << rig.state();
  EXPECT_LE(back, 2000);
}

TEST(DeviceLoop, a_frozen_mask_parks_at_once_when_the_picture_is_mono) {
  const auto parking_after = [](bool mono) {
    bool there = true;
    RigOptions options;
    options.head = [&](double) { return SimulatedHead{.visible = there}; };
    LoopRig rig(options);
    rig.loop.send(SetPictureMono{false});
    rig.start();
    there = false;
    EXPECT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::frozen; }), 0);
    if (mono) rig.loop.send(SetPictureMono{true});
    return rig.run_until([&] { return rig.mask().phase != MaskPhase::frozen; });
  };
  EXPECT_LE(parking_after(true), 12);
  EXPECT_GE(parking_after(false), 200);
}

TEST(DeviceLoop, an_unplugged_tracker_is_absent_with_the_next_tick) {
  LoopRig rig;
  rig.start();
  rig.events();
  rig.tracker_line.unplug();
  rig.tick();
  EXPECT_EQ(rig.eyes().phase, EyesPhase::absent);
  EXPECT_EQ(rig.eyes().times_lost, 1u);
  rig.run_for_ms(1500);
  EXPECT_EQ(rig.eyes().phase, EyesPhase::absent);
  EXPECT_THAT(eyes_phases(rig.events()), ElementsAre(EyesPhase::absent)) << "reported once";
  rig.plug_in_tracker();
  const std::int64_t back = rig.run_until([&] { return rig.tracking() && rig.following(); });
  EXPECT_GE(back, 0);
  EXPECT_LE(back, 2000);
}

TEST(DeviceLoop, an_unplugged_servo_allows_no_stereo) {
  LoopRig rig;
  rig.start();
  rig.servo_line.unplug();
  rig.tick();
  rig.tick();
  EXPECT_EQ(rig.mask().phase, MaskPhase::absent);
  EXPECT_FALSE(rig.mask().stereo_allowed);
  EXPECT_TRUE(rig.tracking());
  rig.run_for_ms(500);
  EXPECT_TRUE(rig.servo.watchdog_tripped()) << "a servo without its host stops by itself";
  rig.plug_in_servo();
  const std::int64_t back = rig.run_until([&] { return rig.following(); });
  EXPECT_GE(back, 0);
  EXPECT_LE(back, 2000);
}

TEST(DeviceLoop, silent_devices_on_open_ports_are_lost_when_their_data_are_old) {
  LoopRig rig;
  rig.start();
  rig.tracker.set_power(false);
  const std::int64_t unseen = rig.run_until([&] { return !rig.tracking(); });
  EXPECT_LE(unseen, 150);
  EXPECT_GE(rig.run_until([&] { return rig.eyes().phase == EyesPhase::silent; }), 0) << rig.state();
  rig.tracker.set_power(true);
  const std::int64_t seen = rig.run_until([&] { return rig.tracking() && rig.following(); });
  EXPECT_GE(seen, 0) << rig.state();
  EXPECT_LE(seen, 2000);

  rig.servo.set_power(false);
  const std::int64_t dead = rig.run_until([&] { return !rig.mask().stereo_allowed; });
  EXPECT_LE(dead, 250);
  EXPECT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::absent; }), 0) << rig.state();
  rig.servo.set_power(true);
  const std::int64_t back = rig.run_until([&] { return rig.following(); });
  EXPECT_GE(back, 0) << rig.state();
  EXPECT_LE(back, 2000);
}

TEST(DeviceLoop, calibration_holds_and_releases_the_mask) {
  LoopRig rig;
  rig.start();
  ASSERT_TRUE(rig.loop.send(SetHold{-0.8}));
  ASSERT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::held && std::abs(rig.mask().position_mm + 0.8) < 0.02; }), 0)
      << rig.state();
  EXPECT_NEAR(rig.servo.mask_mm(), -0.8, 0.03);
  rig.run_for_ms(1000);
  EXPECT_NEAR(rig.servo.mask_mm(), -0.8, 0.03) << "whatever the eyes do";
  ASSERT_TRUE(rig.loop.send(EndHold{}));
  EXPECT_GE(rig.run_until([&] { return rig.following(); }), 0);
}

TEST(DeviceLoop, reports_a_jammed_mask_and_keeps_torque_off_until_rearmed) {
  RigOptions options;
  options.head = [](double seconds) {
    SimulatedHead head;
    head.between_eyes_mm = {120 * std::sin(2 * 3.14159265 * seconds / 3), 0, 650};
    return head;
  };
  LoopRig rig(options);
  rig.start();
  rig.servo.jam(true);
  const std::int64_t found = rig.run_until([&] { return rig.mask().phase == MaskPhase::stuck || rig.mask().phase == MaskPhase::alarm; });
  EXPECT_GE(found, 0);
  EXPECT_LE(found, 3000);
  EXPECT_FALSE(rig.mask().stereo_allowed);
  rig.run_for_ms(200);
  EXPECT_FALSE(rig.servo.torque());
  rig.servo.jam(false);
  rig.run_for_ms(2000);
  EXPECT_FALSE(rig.following()) << "latched until somebody has looked";
  ASSERT_TRUE(rig.loop.send(RequestRearm{}));
  const std::int64_t back = rig.run_until([&] { return rig.following(); });
  EXPECT_GE(back, 0) << rig.state();
}

TEST(DeviceLoop, reports_a_second_fault_during_an_alarm) {
  LoopRig rig;
  rig.start();
  rig.servo.raise_hardware_error(0x20);
  ASSERT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::alarm; }, 200), 0);
  rig.run_for_ms(100);
  rig.events();
  rig.servo.raise_hardware_error(0x04);
  rig.run_for_ms(400);
  std::vector<int> reported;
  for (const LoopEvent& event : rig.events())
    if (const auto* changed = std::get_if<ServoChanged>(&event)) reported.push_back(changed->tick.alarm_bits);
  EXPECT_THAT(reported, ElementsAre(0x24));
}

TEST(DeviceLoop, changes_the_display_without_a_pause) {
  LoopRig rig;
  rig.start();
  SetDisplay display;
  display.optics.zero_mm = 0.1;
  display.eye_separation_mm = 58;
  ASSERT_TRUE(rig.loop.send(display));
  rig.tick();
  EXPECT_EQ(rig.eyes().eye_separation_mm, 58);
  EXPECT_TRUE(rig.tracking());
  EXPECT_GE(rig.run_until([&] { return rig.following(); }, 1000), 0);
}

TEST(DeviceLoop, winding_down_switches_torque_off_and_publishes_it) {
  LoopRig rig;
  rig.start();
  EXPECT_TRUE(rig.servo.torque());
  for (int i = 0; i < 25; ++i) {
    for (int ms = 0; ms < 4; ++ms) {
      rig.clock.advance_ns(kMs);
      rig.servo.step(rig.clock.now_ns());
    }
    rig.loop.wind_down(rig.clock.now_ns());
  }
  EXPECT_FALSE(rig.servo.torque());
  EXPECT_EQ(rig.eyes().phase, EyesPhase::absent);
  EXPECT_EQ(rig.mask().phase, MaskPhase::absent);
  EXPECT_FALSE(rig.mask().stereo_allowed);
}

TEST(DeviceLoop, publishes_that_no_devices_are_configured) {
  ManualClock clock;
  ipc::DevicePage page = ipc::DevicePage::create().value();
  const ipc::DevicePageReader reader = ipc::DevicePageReader::map(page.descriptor()).value();
  DeviceLoop loop({}, {}, page);
  for (int i = 0; i < 100; ++i) {
    clock.advance_ns(kTickPeriodNs);
    loop.tick(clock.now_ns());
  }
  EXPECT_EQ(reader.eyes()->phase, EyesPhase::none);
  EXPECT_EQ(reader.eyes()->time_ns, clock.now_ns());
  EXPECT_EQ(reader.prism()->phase, MaskPhase::absent);
  EXPECT_FALSE(loop.next_event()) << "nothing has changed";
}

TEST(DeviceLoop, refuses_commands_when_the_ring_is_full) {
  ipc::DevicePage page = ipc::DevicePage::create().value();
  DeviceLoop loop({}, {}, page);
  int taken = 0;
  while (loop.send(SetHold{0.1})) ++taken;
  EXPECT_GE(taken, 16);
  EXPECT_FALSE(loop.send(EndHold{}));
  loop.tick(kTickPeriodNs);
  EXPECT_TRUE(loop.send(EndHold{}));
}

TEST(DeviceLoop, reports_changes_later_when_the_ring_is_full) {
  LoopRig rig;
  rig.start();
  rig.events();
  // Nobody reads the events while the mask is held and released repeatedly.
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(rig.loop.send(i % 2 == 0 ? LoopCommand(SetHold{0.1}) : LoopCommand(EndHold{})));
    rig.tick();
  }
  rig.tracker_line.unplug();
  rig.servo.raise_hardware_error(0x20);
  ASSERT_GE(rig.run_until([&] { return rig.mask().phase == MaskPhase::alarm && rig.eyes().phase == EyesPhase::absent; }, 1000), 0);
  for (const LoopEvent& event : rig.events()) {
    const auto* mask_told = std::get_if<MaskChanged>(&event);
    ASSERT_FALSE(std::holds_alternative<EyesChanged>(event) || std::holds_alternative<ServoChanged>(event) ||
                 (mask_told != nullptr && mask_told->phase == MaskPhase::alarm))
        << "the queue wasn't full";
  }
  rig.tick();
  std::optional<EyesPhase> eyes;
  std::optional<MaskPhase> mask;
  std::optional<int> alarm_bits;
  for (const LoopEvent& event : rig.events()) {
    if (const auto* changed = std::get_if<EyesChanged>(&event)) eyes = changed->phase;
    if (const auto* changed = std::get_if<MaskChanged>(&event)) mask = changed->phase;
    if (const auto* changed = std::get_if<ServoChanged>(&event)) alarm_bits = changed->tick.alarm_bits;
  }
  EXPECT_EQ(eyes, EyesPhase::absent);
  EXPECT_EQ(mask, MaskPhase::alarm);
  EXPECT_EQ(alarm_bits, 0x20);
  rig.tick();
  EXPECT_TRUE(rig.events().empty()) << "each is reported once";
}

TEST(DeviceLoop, a_tick_allocates_nothing_whatever_happens) {
  RigOptions options;
  options.tracker.faults = {.drop_out = 0.005, .caution = 0.05, .garbage = 0.01, .damaged_byte = 0.001, .lost_byte = 0.001};
  LoopRig rig(options);
  std::uint64_t before = 0, max_allocations = 0;
  rig.before_tick = [&] { before = drivers::port::allocations_of_this_thread(); };
  rig.after_tick = [&] { max_allocations = std::max(max_allocations, drivers::port::allocations_of_this_thread() - before); };
  rig.run_for_ms(4000);
  EXPECT_EQ(max_allocations, 0u) << "starting up and following";
  for (int i = 0; i < 20; ++i) {
    rig.tracker_line.unplug();
    rig.run_for_ms(120);
    rig.plug_in_tracker();
    rig.run_for_ms(400);
    rig.servo_line.unplug();
    rig.run_for_ms(120);
    rig.plug_in_servo();
    rig.run_for_ms(700);
    rig.loop.send(SetHold{0.3});
    rig.run_for_ms(100);
    rig.loop.send(EndHold{});
    rig.loop.send(RequestRearm{});
    rig.run_for_ms(300);
    rig.loop.send(SetDisplay{});
  }
  rig.servo.raise_hardware_error(0x20);
  rig.run_for_ms(1000);
  EXPECT_EQ(max_allocations, 0u);
  const std::uint64_t start = drivers::port::allocations_of_this_thread();
  ::operator delete(::operator new(8));
  EXPECT_EQ(drivers::port::allocations_of_this_thread(), start + 1) << "the counter counts";
}

}  // namespace
}  // namespace prismesh::deviced
