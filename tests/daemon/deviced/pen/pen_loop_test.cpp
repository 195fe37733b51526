// The pen's loop in virtual time, and the parts around it.
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "daemon/deviced/pen/pen_thread.h"
#include "daemon/deviced/pen/record_store.h"
#include "drivers/haptics/replay.h"
#include "drivers/haptics/safety_words.h"
#include "tests/daemon/deviced/pen/pen_loop_rig.h"

namespace prismesh::deviced::pen {
namespace {

namespace fs = std::filesystem;
using drivers::haptics::SafetyFault;
using drivers::haptics::SafetyPhase;
using drivers::haptics::SafetyRecord;
using ipc::PenStage;

TEST(PenLoop, sends_zero_until_it_is_armed_and_after_it_was_disarmed) {
  PenLoopRig rig;
  rig.run_ms(100);
  EXPECT_EQ(rig.state().stage, PenStage::disarmed);
  EXPECT_TRUE(rig.zeros_from(0));
  EXPECT_GT(rig.seen.size(), 90U);
  rig.arm();
  EXPECT_EQ(rig.state().stage, PenStage::armed);
  EXPECT_EQ(rig.state().arms_answered, 1U);
  EXPECT_FALSE(rig.state().arm_refused);
  EXPECT_FALSE(rig.zeros_from(0));
  EXPECT_EQ(rig.loop.record().phase, SafetyPhase::armed);
  rig.loop.send(RequestDisarm{});
  rig.run_ms(5);
  EXPECT_EQ(rig.state().stage, PenStage::disarmed);
  const std::size_t from = rig.seen.size();
  rig.run_ms(200);
  EXPECT_TRUE(rig.zeros_from(from));
}

TEST(PenLoop, latches_and_gives_the_line_back_when_the_guard_has_taken_it) {
  PenLoopRig rig;
  rig.arm();
  ASSERT_EQ(rig.state().stage, PenStage::armed);
  rig.guard.token = LineToken::tripped;
  const std::size_t from = rig.seen.size();
  rig.run_ms(1);
  EXPECT_EQ(rig.state().stage, PenStage::latched);
  EXPECT_EQ(rig.state().fault, SafetyFault::io_error);
  EXPECT_EQ(rig.guard.token, LineToken::idle);
  rig.run_ms(200);
  EXPECT_TRUE(rig.zeros_from(from + 1)) << "one frame may have been on its way";
  rig.arm();
  EXPECT_EQ(rig.state().stage, PenStage::armed);
}

TEST(PenLoop, writes_nothing_while_the_guard_has_the_line) {
  PenLoopRig rig;
  rig.guard.token = LineToken::tripped;
  EXPECT_EQ(rig.guarded.write(std::vector<std::byte>(4)).bytes, 0U);
  rig.guard.acknowledge();
  EXPECT_EQ(rig.guarded.write(std::vector<std::byte>(4)).bytes, 4U);
  EXPECT_EQ(rig.guard.token, LineToken::idle);
}

TEST(PenLoop, latches_when_it_stood_still_and_when_the_line_is_unplugged) {
  PenLoopRig late;
  late.arm();
  late.tick(30'000'000);
  EXPECT_EQ(late.state().stage, PenStage::latched);
  EXPECT_EQ(late.state().fault, SafetyFault::late_tick);
  PenLoopRig unplugged;
  unplugged.arm();
  unplugged.line.unplug();
  unplugged.run_ms(3);
  EXPECT_EQ(unplugged.state().stage, PenStage::latched);
  EXPECT_EQ(unplugged.state().fault, SafetyFault::io_error);
  EXPECT_TRUE(unplugged.pen.gone());
}

TEST(PenLoop, starts_latched_by_what_was_stored) {
  PenLoopRig rig({SafetyPhase::armed, SafetyFault::none, 0});
  rig.run_ms(50);
  EXPECT_EQ(rig.state().stage, PenStage::latched);
  EXPECT_EQ(rig.state().fault, SafetyFault::died_armed);
  EXPECT_TRUE(rig.zeros_from(0));
}

TEST(PenLoop, beats_at_each_tick) {
  PenLoopRig rig;
  rig.run_ms(10);
  EXPECT_EQ(rig.guard.beats, 10U);
}

TEST(PenLoop, keeps_its_last_ticks_so_that_they_can_be_replayed) {
  PenLoopRig rig;
  rig.run_ms(700);
  rig.arm();
  EXPECT_EQ(rig.state().stage, ipc::PenStage::armed);
  rig.run_ms(900);
  rig.tick(20'000'000);
  EXPECT_EQ(rig.state().fault, drivers::haptics::SafetyFault::late_tick);
  rig.run_ms(100);
  const auto page = ipc::PenPageReader::map(rig.page.descriptor()).value();
  drivers::haptics::PenRecord record;
  ASSERT_TRUE(page.limits());
  record.limits = *page.limits();
  for (std::uint64_t n = 0; n < page.ticks().count(); ++n) record.ticks.push_back(page.ticks().read(n).value());
  ASSERT_GT(record.ticks.size(), 1900u);
  drivers::haptics::ReplayReport report = drivers::haptics::replay(record);
  EXPECT_EQ(report.differing, 0u);
  EXPECT_EQ(report.forces_compared, record.ticks.size());
  EXPECT_GT(report.max_newton, 0);
  ASSERT_EQ(report.changes.size(), 3u);
  EXPECT_EQ(report.changes[2].fault, drivers::haptics::SafetyFault::late_tick);

  // Once the ring is full, the oldest go.
  rig.run_ms(static_cast<int>(ipc::PenTickRing::kTicks));
  EXPECT_FALSE(page.ticks().read(0));
  EXPECT_FALSE(page.ticks().read(page.ticks().count()));
  EXPECT_TRUE(page.ticks().read(page.ticks().count() - ipc::PenTickRing::kTicks + 1));
}

TEST(PenTicks, are_skipped_after_a_stall) {
  EXPECT_EQ(next_pen_tick_ns(0, 100), 1'000'000);
  EXPECT_EQ(next_pen_tick_ns(0, 1'000'001), 1'000'000);
  EXPECT_EQ(next_pen_tick_ns(0, 57'300'000), 57'000'000);
}

TEST(TimeTables, give_the_time_of_a_share) {
  TimeTable table;
  EXPECT_EQ(table.share_ns(0.99), 0);
  for (int us = 1; us <= 100; ++us) table.add(us * 1000);
  EXPECT_EQ(table.share_ns(0.5), 50'000);
  EXPECT_EQ(table.share_ns(0.99), 99'000);
  table.add(std::int64_t{1} << 50);
  EXPECT_EQ(table.share_ns(1), 2047'000);
}

TEST(Records, come_back_from_disk_and_a_spoilt_one_latches) {
  std::string name = (fs::temp_directory_path() / "prismesh-record-XXXXXX").string();
  const fs::path folder = ::mkdtemp(name.data());
  {
    RecordStore store(folder);
    EXPECT_EQ(store.stored(), SafetyRecord());
    ASSERT_TRUE(store.store({SafetyPhase::latched, SafetyFault::too_fast, 5}));
  }
  EXPECT_EQ(RecordStore(folder).stored(), (SafetyRecord{SafetyPhase::latched, SafetyFault::too_fast, 0}));
  for (std::uint32_t fault = 0; fault <= static_cast<std::uint32_t>(SafetyFault::died_armed); ++fault) {
    const SafetyRecord record{SafetyPhase::latched, static_cast<SafetyFault>(fault), 0};
    EXPECT_EQ(parse_record(record_text(record)), record);
    EXPECT_NE(fault_sentence(record.fault).find("until it is armed again"), std::string::npos);
  }
  std::ofstream(folder / "pen-safety") << "latch";
  EXPECT_EQ(RecordStore(folder).stored(), (SafetyRecord{SafetyPhase::latched, SafetyFault::died_armed, 0}));
  fs::remove_all(folder);
}

/// A pen whose line may be stuck.
class StuckPen final : public drivers::haptic_pen::HapticPen {
 public:
  drivers::haptic_pen::PenReading read(std::int64_t) override { return {}; }
  void send(std::int64_t, const drivers::haptic_pen::PenCommand&) override {}
  const drivers::haptic_pen::PenLimits& limits() const override { return limits_; }
  bool gone() const override { return false; }
  bool is_stuck(std::int64_t) override { return stuck; }
  bool stuck = false;

 private:
  drivers::haptic_pen::PenLimits limits_;
};

TEST(PenLoop, leaves_a_line_that_is_stuck_to_the_guard) {
  StuckPen pen;
  FieldReader fields;
  GuardPage guard;
  ipc::PenPage page = ipc::PenPage::create().value();
  PenLoop loop({}, pen, fields, guard, page, {}, {});
  loop.tick(1'000'000'000);
  EXPECT_EQ(guard.beats, 1u);
  pen.stuck = true;
  loop.tick(1'001'000'000);
  EXPECT_EQ(guard.beats, 1u);
  pen.stuck = false;
  loop.tick(1'002'000'000);
  EXPECT_EQ(guard.beats, 2u);
}

}  // namespace
}  // namespace prismesh::deviced::pen
