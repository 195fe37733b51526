// Driver and simulated device together, in virtual time, over a cable that can be unplugged.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/plausible.h"
#include "tests/drivers/eye_tracker/tracker_station.h"

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

using Device = TrackerStation::Device;
using Driver = TrackerStation::Driver;

// A poll comes up to 5 ms after the record's last byte: 1.25 mm at 250 mm/s, plus the record's own rounding.
constexpr double kExactMm = 1.4;

TEST(DynasightStation, each_dialect_streams_sixty_correct_positions_a_second) {
  for (const auto dialect : {settings::TrackerDialect::dynasight, settings::TrackerDialect::d4d}) {
    TrackerStation station({.dialect = dialect, .noise_mm = 0}, {.dialect = dialect});
    station.run(1);
    EXPECT_TRUE(station.tracker()->synchronised());
    const auto samples = station.run(5);
    EXPECT_NEAR(static_cast<double>(samples.size()), 300, 2);
    EXPECT_LE(station.worst_error_mm(samples), kExactMm);
    EXPECT_EQ(station.tracker()->counts().resyncs, 0u);
    EXPECT_EQ(station.tracker()->counts().restarts, 0u);
  }
}

TEST(DynasightStation, the_first_sample_comes_within_200_ms) {
  TrackerStation station;
  EXPECT_FALSE(station.run(0.2).empty());
}

TEST(DynasightStation, polled_mode_is_as_accurate_and_limited_only_by_line_and_loop) {
  TrackerStation station({.noise_mm = 0}, {.polled = true});
  station.run(1);
  const auto samples = station.run(5);
  EXPECT_GE(samples.size(), 5u * 60);
  EXPECT_LE(station.worst_error_mm(samples), kExactMm);
}

TEST(DynasightStation, the_wrong_dialect_counts_as_silence) {
  TrackerStation station({.dialect = settings::TrackerDialect::dynasight}, {.dialect = settings::TrackerDialect::d4d});
  EXPECT_TRUE(station.run(3).empty());
  EXPECT_FALSE(station.tracker()->synchronised());
  EXPECT_GE(station.tracker()->counts().restarts, 4u);
  EXPECT_GT(station.device().unknown_commands(), 4u);
}

TEST(DynasightStation, the_wrong_baud_rate_never_gives_a_head) {
  TrackerStation station;
  port::MemoryLineSettings settings = line_of(19200);
  settings.device_baud = 9600;
  ManualClock clock;
  port::MemoryLine line(clock, settings);
  const auto port = *line.open_host();
  DynasightSimulator device(line.device(), swaying_head, {.streams_at_power_up = true});
  DynasightTracker tracker(*port, {});
  for (int i = 0; i < 4000; ++i) {
    clock.advance_ns(5 * kMs);
    device.run_until(clock.now_ns());
    EXPECT_FALSE(tracker.poll(clock.now_ns()).fresh);
  }
  EXPECT_EQ(tracker.counts().records, 0u);
  EXPECT_GT(tracker.counts().bytes_skipped, 0u);
}

TEST(DynasightStation, waits_for_a_device_that_starts_slowly) {
  TrackerStation station({.power_up_ns = 3'000 * kMs});
  EXPECT_TRUE(station.run(3).empty());
  EXPECT_FALSE(station.run(1).empty());
}

TEST(DynasightStation, restarts_the_dialogue_with_a_rebooted_device) {
  for (const bool polled : {false, true}) {
    TrackerStation station({.power_up_ns = 200 * kMs}, {.polled = polled});
    EXPECT_FALSE(station.run(2).empty());
    station.device().set_power(false);
    station.run(0.1);
    station.device().set_power(true);
    station.run(1);
    EXPECT_FALSE(station.run(0.5).empty());
    EXPECT_TRUE(station.tracker()->synchronised());
    EXPECT_GE(station.tracker()->counts().restarts, 1u);
  }
}

TEST(DynasightStation, takes_over_a_tracker_that_streams_already) {
  TrackerStation station({.streams_at_power_up = true});
  EXPECT_FALSE(station.run(0.25).empty());
}

TEST(DynasightStation, a_head_out_of_sight_gives_no_samples_and_keeps_synchronisation) {
  HeadSource there_and_away = [](double seconds) {
    SimulatedHead head = swaying_head(seconds);
    head.visible = seconds < 2 || seconds > 4;
    return head;
  };
  TrackerStation station({}, {}, there_and_away);
  station.run(2.1);
  const auto away = station.run(1.8);
  EXPECT_TRUE(away.empty());
  EXPECT_TRUE(station.tracker()->synchronised());
  EXPECT_NEAR(static_cast<double>(station.tracker()->counts().without_head), 1.9 * 60, 4);
  station.run(0.2);
  EXPECT_FALSE(station.run(0.1).empty());
}

TEST(DynasightStation, drop_outs_coast_first_and_cautious_records_are_doubtful) {
  TrackerStation station({.noise_mm = 0, .faults = {.drop_out = 0.02, .caution = 0.1}});
  const auto samples = station.run(60);
  const auto doubtful = std::count_if(samples.begin(), samples.end(), [](const HeadSample& sample) { return sample.doubtful; });
  EXPECT_GT(doubtful, 100);
  EXPECT_GT(station.tracker()->counts().without_head, 100u);
  for (const HeadSample& sample : samples) {
    if (sample.doubtful) continue;
    EXPECT_LE((sample.between_eyes_mm - station.truth_mm(sample.measured_ns)).norm(), kExactMm);
  }
}

TEST(DynasightStation, noise_on_the_line_loses_samples_but_gives_no_outlier) {
  TrackerStation station({.noise_mm = 0.3, .faults = {.garbage = 0.05, .damaged_byte = 0.01, .lost_byte = 0.003}, .seed = 4});
  const auto samples = station.run(120);
  EXPECT_GT(samples.size(), 120u * 60 / 2);
  for (const HeadSample& sample : samples) {
    EXPECT_TRUE(plausible_head(sample.between_eyes_mm));
    EXPECT_LE((sample.between_eyes_mm - station.truth_mm(sample.measured_ns)).cwiseAbs().maxCoeff(), 2 * kMaxStepMm);
  }
  const LineCounts& counts = station.tracker()->counts();
  EXPECT_GT(counts.bytes_skipped, 100u);
  EXPECT_GT(counts.rejected, 10u);
  std::printf("  120 s of noise: %zu of 7200 records became samples, %llu refused, %llu bytes skipped, %llu times resynchronised\n",
              samples.size(), static_cast<unsigned long long>(counts.rejected), static_cast<unsigned long long>(counts.bytes_skipped),
              static_cast<unsigned long long>(counts.resyncs));
}

TEST(DynasightStation, after_a_stall_takes_the_newest_position_with_its_time) {
  TrackerStation station({.noise_mm = 0});
  station.run(1);
  station.stall(0.7);
  std::vector<HeadSample> samples;
  station.poll(samples);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_GE(samples[0].measured_ns, station.clock().now_ns() - (20 + 17 + 5) * kMs);
  EXPECT_LE(station.worst_error_mm(samples), kExactMm);
}

TEST(DynasightStation, sample_times_increase) {
  TrackerStation station({.faults = {.garbage = 0.3}});
  std::int64_t last = -1'000'000'000;
  for (int i = 0; i < 40; ++i) {
    for (const HeadSample& sample : station.run(0.3)) {
      EXPECT_GT(sample.measured_ns, last);
      last = sample.measured_ns;
    }
    station.stall(0.05 * (i % 5));
  }
}

TEST(DynasightStation, after_an_unplug_at_any_byte_is_gone_at_once_and_back_within_200_ms) {
  TrackerStation station;
  double max_ms = 0;
  for (std::size_t byte = 0; byte < 200; ++byte) {
    station.line().unplug_after(port::Direction::to_host, byte);
    const std::int64_t armed_ns = station.clock().now_ns();
    while (station.tracker() != nullptr) {
      ASSERT_LT(station.clock().now_ns() - armed_ns, 2'000 * kMs);
      station.run(0.005);
    }
    station.stall(0.02);
    station.plug_in();
    const std::int64_t plugged_ns = station.clock().now_ns();
    while (station.run(0.005).empty()) ASSERT_LT(station.clock().now_ns() - plugged_ns, 1'000 * kMs) << "after byte " << byte;
    max_ms = std::max(max_ms, static_cast<double>(station.clock().now_ns() - plugged_ns) / kMs);
  }
  // Settling (50), five records (83), the line and the poll (10); sixteen records if z's low byte looks like a marker.
  EXPECT_LE(max_ms, 350);
  std::printf("  200 unplugs, one at each byte: first sample after plugging in within %.0f ms\n", max_ms);
}

TEST(DynasightStation, comes_back_after_an_unplug_during_commands) {
  for (std::size_t byte = 0; byte < 8; ++byte)
    for (const bool polled : {false, true}) {
      TrackerStation station({}, {.polled = polled});
      station.line().unplug_after(port::Direction::to_device, byte);
      station.run(1);
      if (station.tracker() == nullptr) station.plug_in();
      EXPECT_FALSE(station.run(1.5).empty()) << byte;
    }
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::dynasight
