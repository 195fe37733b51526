#include "drivers/port/port_keeper.h"

#include <limits>

#include <gtest/gtest.h>

#include "drivers/port/memory_line.h"
#include "tests/drivers/port/allocations.h"
#include "tests/drivers/port/bytes.h"

namespace prismesh::drivers::port {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// A line in memory, its keeper, and both sides' calls of the keeper.
struct KeeperFixture {
  ManualClock clock;
  MemoryLine line{clock, {}};
  PortKeeper keeper{clock, [this] { return line.open_host(); }, "/dev/a"};

  void advance_to_ms(std::int64_t ms) { clock.advance_ns(ms * kMs - clock.now_ns()); }
  /// Calls `work` at each due time until `ms`; returns the times of the attempts.
  std::vector<std::int64_t> attempts_until_ms(std::int64_t ms) {
    std::vector<std::int64_t> at;
    for (std::int64_t due = keeper.work(); due <= ms * kMs; due = keeper.work()) {
      clock.advance_ns(due - clock.now_ns());
      const std::uint64_t before = keeper.report().attempts;
      keeper.work();
      if (keeper.report().attempts > before) at.push_back(clock.now_ns() / kMs);
    }
    advance_to_ms(ms);
    return at;
  }
  /// What a real-time loop does with a dead port.
  bool tick() {
    BytePort* port = keeper.port();
    if (port == nullptr) return false;
    std::array<std::byte, 16> buffer{};
    if (port->read(buffer).status != PortStatus::gone) return true;
    keeper.give_back();
    return false;
  }
};

TEST(PortKeeper, opens_at_once_and_offers_the_port) {
  KeeperFixture fixture;
  EXPECT_EQ(fixture.keeper.port(), nullptr);
  EXPECT_EQ(fixture.keeper.work(), kNever);
  BytePort* port = fixture.keeper.port();
  ASSERT_NE(port, nullptr);
  EXPECT_EQ(fixture.keeper.port(), port) << "the same until it's given back";
  EXPECT_TRUE(fixture.keeper.report().open);
}

TEST(PortKeeper, waiting_times_double_up_to_a_second) {
  KeeperFixture fixture;
  fixture.line.unplug();
  fixture.keeper.work();
  EXPECT_EQ(fixture.attempts_until_ms(5000), (std::vector<std::int64_t>{50, 150, 350, 750, 1550, 2550, 3550, 4550}));
  const KeeperReport report = fixture.keeper.report();
  EXPECT_FALSE(report.open);
  EXPECT_EQ(report.attempts, 9u);
  EXPECT_EQ(report.openings, 0u);
  ASSERT_TRUE(report.reason);
  EXPECT_NE(report.reason->message.find("is it plugged in"), std::string::npos);
}

TEST(PortKeeper, work_before_the_due_time_does_nothing) {
  KeeperFixture fixture;
  fixture.line.unplug();
  fixture.keeper.work();
  for (int i = 0; i < 49; ++i) {
    fixture.clock.advance_ns(kMs);
    EXPECT_EQ(fixture.keeper.work(), 50 * kMs);
  }
  EXPECT_EQ(fixture.keeper.report().attempts, 1u);
}

TEST(PortKeeper, retry_now_ends_the_wait_and_resets_the_back_off) {
  KeeperFixture fixture;
  fixture.line.unplug();
  fixture.attempts_until_ms(3000);
  fixture.keeper.retry_now();
  // the file exists, but the device isn't ready yet: the attempts are close together again
  EXPECT_EQ(fixture.keeper.work(), 3050 * kMs);
  EXPECT_EQ(fixture.attempts_until_ms(3400), (std::vector<std::int64_t>{3050, 3150, 3350}));
  fixture.line.plug_in();
  fixture.keeper.retry_now();
  fixture.keeper.work();
  EXPECT_NE(fixture.keeper.port(), nullptr);
}

TEST(PortKeeper, a_proven_port_that_is_gone_is_reopened_at_once) {
  KeeperFixture fixture;
  fixture.keeper.work();
  ASSERT_TRUE(fixture.tick());
  fixture.advance_to_ms(5000);
  fixture.line.unplug();
  EXPECT_FALSE(fixture.tick());
  EXPECT_EQ(fixture.keeper.port(), nullptr);
  fixture.line.plug_in();
  fixture.keeper.work();
  EXPECT_TRUE(fixture.tick());
  EXPECT_FALSE(fixture.keeper.report().reason);
  EXPECT_EQ(fixture.keeper.report().openings, 2u);
}

TEST(PortKeeper, a_port_that_fails_right_after_opening_is_reopened_with_pauses) {
  KeeperFixture fixture;
  int openings = 0;
  for (std::int64_t ms = 0; ms < 10'000; ++ms) {
    fixture.advance_to_ms(ms);
    fixture.line.plug_in();
    fixture.keeper.work();
    openings += fixture.tick();
    fixture.line.unplug();
    fixture.tick();
  }
  EXPECT_EQ(openings, 14) << "50, 100, 200, 400, 800 ms, then each second";
}

TEST(PortKeeper, reports_a_port_that_went_away) {
  KeeperFixture fixture;
  fixture.keeper.work();
  ASSERT_TRUE(fixture.tick());
  fixture.clock.advance_ns(100 * kMs);  // not proven yet, so the next attempt waits
  fixture.line.unplug();
  EXPECT_FALSE(fixture.tick());
  fixture.keeper.work();
  const KeeperReport report = fixture.keeper.report();
  EXPECT_FALSE(report.open);
  ASSERT_TRUE(report.reason);
  EXPECT_EQ(report.reason->text(), "/dev/a: went away: Input/output error");
}

TEST(PortKeeper, give_back_without_a_port_does_nothing) {
  KeeperFixture fixture;
  fixture.keeper.give_back();
  fixture.keeper.work();
  EXPECT_NE(fixture.keeper.port(), nullptr);
}

TEST(PortKeeper, give_back_wakes_the_other_side) {
  KeeperFixture fixture;
  int woken = 0;
  fixture.keeper.on_give_back([](void* count) { ++*static_cast<int*>(count); }, &woken);
  fixture.keeper.work();
  fixture.keeper.port();
  fixture.keeper.give_back();
  EXPECT_EQ(woken, 1);
}

/// Reports when it's closed.
class MortalPort final : public BytePort {
 public:
  explicit MortalPort(int& alive) : alive_(alive) { ++alive_; }
  ~MortalPort() override { --alive_; }
  PortCount read(std::span<std::byte>) override { return {}; }
  PortCount write(std::span<const std::byte>) override { return {}; }
  void discard_input() override {}
  bool set_baud(int) override { return true; }
  int last_error() const override { return 0; }

 private:
  int& alive_;
};

TEST(PortKeeper, closes_outside_the_tick_and_never_has_two_ports) {
  ManualClock clock;
  int alive = 0;
  const auto make = [&]() -> Result<std::unique_ptr<BytePort>> { return std::make_unique<MortalPort>(alive); };
  {
    PortKeeper keeper(clock, make);
    for (int i = 0; i < 3; ++i) {
      clock.advance_ns(2000 * kMs);
      keeper.work();
      EXPECT_EQ(alive, 1);
      keeper.port();
      keeper.give_back();
      EXPECT_EQ(alive, 1) << "the real-time side closes nothing";
    }
    clock.advance_ns(2000 * kMs);
    keeper.work();  // an offered port that is never taken
    EXPECT_EQ(alive, 1);
  }
  EXPECT_EQ(alive, 0);
  {
    PortKeeper keeper(clock, make);
    keeper.work();
    keeper.port();
  }
  EXPECT_EQ(alive, 0) << "nor is one that was taken left open";
}

TEST(PortKeeper, the_real_time_side_allocates_nothing) {
  ManualClock clock;
  int alive = 0;
  PortKeeper keeper(clock, [&]() -> Result<std::unique_ptr<BytePort>> { return std::make_unique<MortalPort>(alive); });
  std::uint64_t made = 0;
  for (int i = 0; i < 100; ++i) {
    clock.advance_ns(2000 * kMs);
    keeper.work();
    const std::uint64_t before = allocations_of_this_thread();
    ASSERT_NE(keeper.port(), nullptr);
    keeper.give_back();
    keeper.port();
    made += allocations_of_this_thread() - before;
  }
  EXPECT_EQ(made, 0u);
}

}  // namespace
}  // namespace prismesh::drivers::port
