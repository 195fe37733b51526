// For any input bytes no sample is out of range and no poll allocates; after the noise, clean records give samples again.
#include <cmath>
#include <deque>
#include <random>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/configured/tracker.h"
#include "drivers/eye_tracker/opentrack/datagram.h"
#include "drivers/eye_tracker/plausible.h"
#include "tests/drivers/eye_tracker/tracker_station.h"
#include "tests/drivers/port/allocations.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using configured::ConfiguredTracker;

using Random = std::mt19937_64;
constexpr std::int64_t kMillisecondNs = 1'000'000;

void expect_sound(const EyeTracker::Polled& polled) {
  if (!polled.fresh) return;
  EXPECT_TRUE(plausible_head(polled.sample.between_eyes_mm)) << polled.sample.between_eyes_mm.transpose();
  EXPECT_NEAR(polled.sample.toward_right.norm(), 1, 1e-9);
}

/// Noise of several kinds: random bytes, mostly markers, parts of records, one byte repeated.
std::vector<std::byte> hostile(Random& random, std::size_t count) {
  std::vector<std::byte> bytes;
  const auto any = [&] { return static_cast<std::byte>(random() & 0xFF); };
  const auto kind = random() % 5;
  const std::byte same = any();
  while (bytes.size() < count) {
    switch (kind) {
      case 0: bytes.push_back(any()); break;
      case 1: bytes.push_back(random() % 3 == 0 ? any() : std::byte{0x80} | (any() & std::byte{0x0F})); break;
      case 2: bytes.push_back(same); break;
      default: {
        const double spread = kind == 3 ? 20'000 : 100;
        std::uniform_real_distribution<double> place(-spread, spread);
        const auto record = dynasight::encode(dynasight::record_for(
            {place(random), place(random), place(random)}, static_cast<dynasight::Status>(random() % 4), static_cast<int>(random() % 8)));
        bytes.insert(bytes.end(), record.begin(), record.begin() + static_cast<std::ptrdiff_t>(random() % 3 == 0 ? random() % 9 : 8));
      }
    }
  }
  return bytes;
}

TEST(PlausibleHead, is_10_cm_to_4_m_before_the_screen_and_not_far_aside) {
  const double nan = std::nan("");
  EXPECT_TRUE(plausible_head({0, 0, 650}));
  EXPECT_TRUE(plausible_head({0, 0, 100}));
  EXPECT_FALSE(plausible_head({0, 0, 99.9}));
  EXPECT_FALSE(plausible_head({0, 0, -650})) << "behind the screen";
  EXPECT_TRUE(plausible_head({0, 0, 4000}));
  EXPECT_FALSE(plausible_head({0, 0, 4000.1}));
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(plausible_head({side * 1400, 0, 650}));
    EXPECT_FALSE(plausible_head({side * 1400.1, 0, 650}));
    EXPECT_TRUE(plausible_head({0, side * 1400, 650}));
    EXPECT_FALSE(plausible_head({0, side * 1400.1, 650}));
  }
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d place(0, 0, 650);
    place[axis] = nan;
    EXPECT_FALSE(plausible_head(place)) << "axis " << axis;
  }
}

TEST(HostileBytes, no_sample_is_out_of_range_and_clean_records_give_samples_again) {
  Random random(1);
  for (int round = 0; round < 300; ++round) {
    ManualClock clock;
    port::MemoryLine line(clock, dynasight::line_of(1'000'000));
    const auto port = *line.open_host();
    dynasight::DynasightTracker tracker(*port, {});
    const auto poll = [&] {
      clock.advance_ns(5 * kMillisecondNs);
      const auto polled = tracker.poll(clock.now_ns());
      expect_sound(polled);
      return polled.fresh;
    };
    const auto bytes = hostile(random, 4000);
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t chunk = std::min<std::size_t>(1 + random() % 60, bytes.size() - at);
      line.device().write(std::span(bytes).subspan(at, chunk));
      at += chunk;
      poll();
    }
    int needed = 0;
    bool sampled = false;
    for (; needed < 60 && !sampled; ++needed) {
      line.device().write(dynasight::encode(dynasight::record_for({10, 20, 650 + 0.3 * needed})));
      sampled = poll();
    }
    // Four agreeing records and one to confirm; if the dialogue restarts in between, 50 ms are discarded.
    EXPECT_LE(needed, 5 + 1 + 11) << "round " << round;
  }
}

TEST(HostileBytes, opentrack_reports_no_sample_out_of_range) {
  Random random(2);
  for (int i = 0; i < 200'000; ++i) {
    std::array<std::byte, opentrack::kDatagramBytes> datagram{};
    for (std::byte& byte : datagram) byte = static_cast<std::byte>(random() & 0xFF);
    // Set exponents in the range of a pose's numbers; otherwise almost no datagram passes the first check.
    for (std::size_t k = 0; k < 6; ++k) datagram[8 * k + 7] = random() % 2 == 0 ? std::byte{0x40} : std::byte{0xC0};
    class OnePort final : public port::DatagramPort {
     public:
      explicit OnePort(std::span<const std::byte> datagram) : datagram_(datagram) {}
      port::Datagram receive(std::span<std::byte> to) override {
        if (std::exchange(taken_, true)) return {};
        std::copy(datagram_.begin(), datagram_.end(), to.begin());
        return {.arrived = true, .bytes = datagram_.size(), .full_length = datagram_.size()};
      }
      void discard_input() override {}
      int last_error() const override { return 0; }

     private:
      std::span<const std::byte> datagram_;
      bool taken_ = false;
    } port(datagram);
    opentrack::OpentrackTracker tracker(port, {});
    expect_sound(tracker.poll(0));
  }
}

TEST(HostileBytes, polling_attaching_and_detaching_allocate_nothing) {
  dynasight::TrackerStation station({.faults = {.drop_out = 0.01, .garbage = 0.2, .damaged_byte = 0.01, .lost_byte = 0.01}});
  settings::EyeTrackerSettings settings;
  settings.driver = settings::TrackerDriver::dynasight;
  ConfiguredTracker configured(settings);
  const auto port = *station.line().open_host();
  bool sampled = false;
  std::uint64_t allocated = 0;
  for (int life = 0; life < 5; ++life) {
    const std::uint64_t before_sitting = port::allocations_of_this_thread();
    EyeTracker& tracker = configured.attach(*port);
    allocated += port::allocations_of_this_thread() - before_sitting;
    EXPECT_EQ(configured.tracker(), &tracker);
    for (int i = 0; i < 400; ++i) {
      for (int k = 0; k < 20; ++k) {
        station.clock().advance_ns(kMillisecondNs / 4);
        station.device().run_until(station.clock().now_ns());
      }
      const std::uint64_t before = port::allocations_of_this_thread();
      sampled |= tracker.poll(station.clock().now_ns()).fresh;
      allocated += port::allocations_of_this_thread() - before;
    }
    const std::uint64_t before_leaving = port::allocations_of_this_thread();
    configured.detach();
    allocated += port::allocations_of_this_thread() - before_leaving;
    EXPECT_EQ(configured.tracker(), nullptr);
  }
  EXPECT_TRUE(sampled);
  EXPECT_EQ(allocated, 0u);
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker
