// Eyes that pictures are drawn for, in virtual time: prediction, constant eyes while the head is still, mono in time if anything fails.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/eye_tracker/head_motion.h"
#include "kiosk/stereo/tracked_eyes.h"

namespace prismesh::kiosk::stereo {
namespace {

using drivers::eye_tracker::HeadFilter;
using drivers::eye_tracker::HeadMotion;
using drivers::eye_tracker::MotionKind;
using drivers::prism_servo::MaskPhase;
using Eigen::Vector3d;

constexpr std::int64_t kMillisecondNs = 1'000'000, kMaxDepthAgeNs = 250 * kMillisecondNs, kStart = 10'000 * kMillisecondNs;

/// A picture on the display, with the true times at which it was seen.
struct Shown {
  std::int64_t lit_ns = 0;
  std::int64_t until_ns = 0;
  SeenFrom seen;
};

/// A tracker at 60 Hz with a default delay of 20 ms and 1 mm of noise, the daemon's page at 200 Hz, and a kiosk that reads it at each
/// refresh.
class World {
 public:
  explicit World(const FollowOptions& options, const HeadMotion& motion = HeadMotion(MotionKind::still, 1))
      : eyes(options), motion_(motion), filter_({1}) {
    clock_.advance_ns(kStart);
    reading.eyes.emplace();
    reading.prism.emplace();
  }

  std::int64_t now() { return clock_.now_ns(); }
  double seconds() { return static_cast<double>(now() - kStart) * 1e-9; }
  Vector3d head_at(std::int64_t time_ns) const { return motion_.between_eyes_mm(static_cast<double>(time_ns - kStart) * 1e-9); }

  void run_ms(std::int64_t ms) {
    for (std::int64_t i = 0; i < ms; ++i) step();
  }
  void run_until_stereo() {
    for (int i = 0; i < 3000 && (looks == 0 || seen.depth_share < 1); ++i) step();
    ASSERT_EQ(seen.depth_share, 1);
  }
  void close_pictures() {
    if (!pictures.empty()) pictures.back().until_ns = now();
  }

  TrackedEyes eyes;
  DeviceReading reading;  ///< what the kiosk reads
  SeenFrom seen;
  std::vector<Shown> pictures;
  std::size_t looks = 0;
  bool daemon_runs = true, tracker_sees = true, page_is_there = true, mask_is_told = true;
  std::int64_t draw_ms = 3, latency_ms = 20;
  std::int64_t last_measured_ns = 0;

 private:
  void step() {
    clock_.advance_ns(kMillisecondNs);
    const std::int64_t ms = (now() - kStart) / kMillisecondNs;
    if (tracker_sees && ms % 17 == 0) measure();
    if (daemon_runs && ms % 5 == 0) publish();
    if (drawn_ns_ != 0 && now() >= drawn_ns_) light_up();
    if (drawn_ns_ == 0 && now() >= timing_.next_begin_ns()) look();
  }
  void measure() {
    const std::int64_t measured = now() - latency_ms * kMillisecondNs;
    if (measured <= kStart) return;
    filter_.take({measured, head_at(measured) + Vector3d(noise_(random_), noise_(random_), noise_(random_)), Vector3d::UnitX(), false});
  }
  void publish() {
    const auto& head = filter_.state();
    ipc::EyesState& to = *reading.eyes;
    to.time_ns = now();
    to.measured_ns = last_measured_ns = head.time_ns;
    std::copy_n(head.between_eyes_mm.data(), 3, to.between_eyes_mm.begin());
    std::copy_n(head.velocity_mm_s.data(), 3, to.velocity_mm_s.begin());
    to.phase = now() - head.time_ns < to.lost_after_ns ? ipc::EyesPhase::tracking : ipc::EyesPhase::searching;
    if (!mask_is_told) return;
    ipc::PrismState& mask = *reading.prism;
    mask.time_ns = mask.measured_ns = now();
  }
  void look() {
    ++looks;
    timing_.begun(now());
    const SeenFrom next = eyes.look(page_is_there ? reading : DeviceReading{}, now(), timing_.lit(now()));
    if (!pictures.empty() && next == seen) return;  // the picture may stay
    seen = next;
    drawn_ns_ = now() + draw_ms * kMillisecondNs;
  }
  /// A drawn picture is seen from the next refresh on, 8 + 10 ms later in the middle of the panel. Refreshes are 17 ms apart; the kiosk
  /// doesn't know their phase.
  void light_up() {
    timing_.drawn(now());
    drawn_ns_ = 0;
    const std::int64_t refresh = (now() / (17 * kMillisecondNs) + 1) * 17 * kMillisecondNs, lit = refresh + 18 * kMillisecondNs;
    if (!pictures.empty()) pictures.back().until_ns = lit;
    pictures.push_back({lit, std::numeric_limits<std::int64_t>::max(), seen});
  }

  ManualClock clock_;
  HeadMotion motion_;
  HeadFilter filter_;
  PictureTiming timing_{{17 * kMillisecondNs, 10 * kMillisecondNs}};
  std::int64_t drawn_ns_ = 0;
  std::mt19937 random_{3};
  std::normal_distribution<double> noise_{0, 1};
};

FollowOptions prism_mask() { return {}; }

void allow_stereo(World& world) {
  world.reading.prism->stereo_allowed = true;
  world.reading.prism->phase = MaskPhase::following;
}

/// The last time at which depth was on the display.
std::int64_t depth_ended_ns(const World& world) {
  std::int64_t ended = 0;
  for (const Shown& shown : world.pictures)
    if (shown.seen.depth_share > 0) ended = std::max(ended, shown.until_ns);
  return ended;
}

TEST(TrackedEyes, depth_rises_smoothly_once_the_head_is_seen_and_the_mask_follows) {
  World world(prism_mask());
  world.run_ms(300);
  EXPECT_EQ(world.seen.depth_share, 0) << "the mask isn't ready";
  allow_stereo(world);
  const std::int64_t allowed = world.now();
  world.run_until_stereo();
  EXPECT_LT(world.now() - allowed, 400 * kMillisecondNs);
  for (std::size_t i = 1; i < world.pictures.size(); ++i)
    EXPECT_LT(std::abs(world.pictures[i].seen.depth_share - world.pictures[i - 1].seen.depth_share), 0.15);
}

TEST(TrackedEyes, the_head_is_predicted_to_the_time_of_light) {
  const HeadMotion motion(MotionKind::turn, 5);
  World world(prism_mask(), motion);
  allow_stereo(world);
  world.run_ms(10'000);
  std::vector<double> predicted, last_known;
  for (const Shown& shown : world.pictures) {
    if (shown.seen.depth_share < 1) continue;
    predicted.push_back((shown.seen.between_eyes_mm - world.head_at(shown.lit_ns)).norm());
    last_known.push_back((world.head_at(shown.lit_ns - 80 * kMillisecondNs) - world.head_at(shown.lit_ns)).norm());
  }
  ASSERT_GT(predicted.size(), 100u);
  const auto p95 = [](std::vector<double>& errors) {
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() * 95 / 100];
  };
  const double with = p95(predicted), without = p95(last_known);
  RecordProperty("p95_mm", std::to_string(with));
  RecordProperty("p95_without_mm", std::to_string(without));
  EXPECT_LT(with, 0.6 * without);
}

TEST(TrackedEyes, a_still_head_gives_a_constant_picture) {
  World world(prism_mask());
  allow_stereo(world);
  world.run_until_stereo();
  world.run_ms(3000);
  const std::size_t pictures = world.pictures.size(), looks = world.looks;
  world.run_ms(20'000);
  EXPECT_GT(world.looks - looks, 1000u);
  EXPECT_LE(world.pictures.size() - pictures, 40u) << "pictures in 20 s of sitting still";
}

TEST(TrackedEyes, lost_eyes_turn_the_picture_mono_in_time_and_smoothly) {
  World world(prism_mask());
  allow_stereo(world);
  world.run_until_stereo();
  world.tracker_sees = false;
  world.run_ms(1000);
  world.close_pictures();
  EXPECT_EQ(world.seen.depth_share, 0);
  EXPECT_LE(depth_ended_ns(world) - world.last_measured_ns, kMaxDepthAgeNs);
  std::size_t between = 0;
  for (const Shown& shown : world.pictures)
    between += shown.lit_ns > world.last_measured_ns && shown.seen.depth_share > 0 && shown.seen.depth_share < 1 ? 1u : 0u;
  EXPECT_GE(between, 3u) << "a fade, not a switch";
  world.tracker_sees = true;
  const std::int64_t back = world.now();
  world.run_until_stereo();
  EXPECT_LT(world.now() - back, 1000 * kMillisecondNs);
}

TEST(TrackedEyes, a_slow_tracker_gives_depth_too) {
  World world(prism_mask());
  allow_stereo(world);
  world.latency_ms = 150;
  world.reading.eyes->lost_after_ns = 230 * kMillisecondNs;
  world.run_until_stereo();
  const std::size_t before = world.pictures.size();
  world.run_ms(1000);
  for (std::size_t i = before; i < world.pictures.size(); ++i) EXPECT_EQ(world.pictures[i].seen.depth_share, 1);
  world.tracker_sees = false;
  world.run_ms(1000);
  world.close_pictures();
  EXPECT_EQ(world.seen.depth_share, 0);
  EXPECT_LE(depth_ended_ns(world) - world.last_measured_ns, kMaxDepthAgeNs + 130 * kMillisecondNs)
      << "the limit counts from the arrival of the last measurement";
}

TEST(TrackedEyes, a_short_gap_is_bridged) {
  World world(prism_mask());
  allow_stereo(world);
  world.run_until_stereo();
  world.tracker_sees = false;
  world.run_ms(50);
  world.tracker_sees = true;
  const std::size_t before = world.pictures.size();
  world.run_ms(500);
  for (std::size_t i = before; i < world.pictures.size(); ++i) EXPECT_EQ(world.pictures[i].seen.depth_share, 1);
}

TEST(TrackedEyes, every_way_to_lose_the_daemon_ends_in_mono) {
  const std::vector<std::function<void(World&)>> ways{
      [](World& w) { w.daemon_runs = false; },                                                  // killed: the page stays and doesn't change
      [](World& w) { w.daemon_runs = w.page_is_there = false; },                                // the link is known to be lost
      [](World& w) { w.daemon_runs = false, w.reading.eyes->phase = ipc::EyesPhase::absent; },  // unplugged
      [](World& w) { w.daemon_runs = false, w.reading.eyes->between_eyes_mm[0] = std::nan(""); },                   // a fault
      [](World& w) { w.daemon_runs = false, w.reading.eyes->measured_ns = w.now() + 3'600'000 * kMillisecondNs; },  // another clock
  };
  for (std::size_t way = 0; way < ways.size(); ++way) {
    World world(prism_mask());
    allow_stereo(world);
    world.run_until_stereo();
    ways[way](world);
    world.run_ms(600);
    world.close_pictures();
    EXPECT_EQ(world.seen.depth_share, 0) << way;
    EXPECT_LE(depth_ended_ns(world) - world.last_measured_ns, kMaxDepthAgeNs) << way;
  }
}

TEST(TrackedEyes, ten_thousand_losses_at_any_moment_always_end_in_mono) {
  std::mt19937 random(11);
  std::int64_t worst = 0;
  for (int round = 0; round < 100; ++round) {
    World world(prism_mask(), HeadMotion(static_cast<MotionKind>(round % 5), static_cast<std::uint64_t>(round)));
    allow_stereo(world);
    for (int loss = 0; loss < 100; ++loss) {
      world.draw_ms = 1 + static_cast<std::int64_t>(random() % (round < 50 ? 16 : 70));
      world.run_ms(300 + static_cast<std::int64_t>(random() % 200));
      bool& what = random() % 2 == 0 ? world.daemon_runs : world.tracker_sees;
      what = false;
      const std::size_t before = world.pictures.size();
      world.run_ms(400);
      ASSERT_EQ(world.seen.depth_share, 0);
      std::int64_t ended = 0;
      for (std::size_t i = before == 0 ? 0 : before - 1; i < world.pictures.size(); ++i)
        if (world.pictures[i].seen.depth_share > 0) ended = std::max(ended, std::min(world.pictures[i].until_ns, world.now()));
      if (ended > 0) worst = std::max(worst, ended - world.last_measured_ns);
      what = true;
    }
  }
  RecordProperty("worst_ms", std::to_string(static_cast<double>(worst) / kMillisecondNs));
  EXPECT_LE(worst, kMaxDepthAgeNs);
  EXPECT_GT(worst, 100 * kMillisecondNs) << "depth was shown after some losses";
}

TEST(TrackedEyes, no_depth_is_seen_while_the_mask_moves_back) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    World world(prism_mask());
    allow_stereo(world);
    world.draw_ms = 1 + static_cast<std::int64_t>(random() % 16);
    world.run_until_stereo();
    world.run_ms(static_cast<std::int64_t>(random() % 50));
    ipc::PrismState& mask = *world.reading.prism;
    mask.mono_from_ns = world.now() + 80 * kMillisecondNs;
    mask.mono_until_ns = mask.mono_from_ns + 120 * kMillisecondNs;
    world.run_ms(80);
    mask.stereo_allowed = false;
    world.run_ms(120);
    mask.stereo_allowed = true;
    world.run_ms(600);
    world.close_pictures();
    for (const Shown& shown : world.pictures)
      if (shown.until_ns > mask.mono_from_ns && shown.lit_ns < mask.mono_until_ns && shown.seen.depth_share > 0) {
        // The kiosk doesn't know the phase of the refreshes: its times may be off by half a period at either end.
        EXPECT_LE(std::min(shown.until_ns - mask.mono_from_ns, mask.mono_until_ns - shown.lit_ns), 9 * kMillisecondNs) << round;
      }
    EXPECT_EQ(world.seen.depth_share, 1) << "back in depth";
  }
}

TEST(TrackedEyes, a_mask_that_stops_following_fades_the_picture) {
  World world(prism_mask());
  allow_stereo(world);
  world.run_until_stereo();
  world.reading.prism->stereo_allowed = false;
  const std::int64_t stopped = world.now();
  world.run_ms(300);
  world.close_pictures();
  EXPECT_EQ(world.seen.depth_share, 0);
  EXPECT_LE(depth_ended_ns(world) - stopped, 200 * kMillisecondNs);
}

TEST(TrackedEyes, missing_states_of_the_mask_fade_the_picture_though_the_eyes_are_seen) {
  World world(prism_mask());
  allow_stereo(world);
  world.run_until_stereo();
  world.mask_is_told = false;
  const std::int64_t heard = world.reading.prism->time_ns;
  while (world.now() - heard < 90 * kMillisecondNs) world.run_ms(1);
  EXPECT_EQ(world.seen.depth_share, 1) << "100 ms are bridged";
  world.run_ms(400);
  world.close_pictures();
  EXPECT_EQ(world.seen.depth_share, 0);
  EXPECT_LE(depth_ended_ns(world) - heard, 300 * kMillisecondNs) << "100 ms, and the fade of a mask that stops";
  world.mask_is_told = true;
  world.run_until_stereo();
}

/// A daemon's reading with eyes at the resting position that were just measured.
DeviceReading eyes_measured_at(std::int64_t measured_ns) {
  DeviceReading reading;
  reading.eyes.emplace();
  reading.eyes->time_ns = reading.eyes->measured_ns = measured_ns;
  reading.eyes->between_eyes_mm = {0, 0, 650};
  reading.eyes->phase = ipc::EyesPhase::tracking;
  return reading;
}

/// Whether a state of the eyes is accepted after good ones.
template <class Change>
bool are_taken(const Change& change) {
  TrackedEyes eyes(prism_mask());
  const auto look = [&](const DeviceReading& reading, std::int64_t now) {
    eyes.look(reading, now, {now + 20 * kMillisecondNs, now + 40 * kMillisecondNs});
  };
  look(eyes_measured_at(kStart), kStart);
  EXPECT_EQ(eyes.measured_ns(), kStart);
  DeviceReading next = eyes_measured_at(kStart + 17 * kMillisecondNs);
  change(*next.eyes);
  look(next, kStart + 17 * kMillisecondNs);
  return eyes.measured_ns() != kStart;
}

TEST(TrackedEyes, impossible_eye_positions_are_ignored) {
  using ipc::EyesState;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(are_taken([](EyesState&) {}));
  for (const double wrong : {nan, infinity, -infinity})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.between_eyes_mm[axis] = wrong; })) << wrong << ", axis " << axis;
      EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.velocity_mm_s[axis] = wrong; })) << wrong << ", axis " << axis;
      EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.toward_right[axis] = wrong; })) << wrong << ", axis " << axis;
    }
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.between_eyes_mm[2] = -650; })) << "behind the screen";
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.between_eyes_mm[2] = 99; })) << "at the glass";
  EXPECT_TRUE(are_taken([](EyesState& eyes) { eyes.between_eyes_mm[2] = 101; }));
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.between_eyes_mm = {3000, 0, 4001}; })) << "more than 5 m away";
  EXPECT_TRUE(are_taken([](EyesState& eyes) { eyes.between_eyes_mm = {3000, 0, 3999}; }));
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.velocity_mm_s = {0, -5001, 0}; })) << "no head moves at 5 m/s";
  EXPECT_TRUE(are_taken([](EyesState& eyes) { eyes.velocity_mm_s = {0, -4999, 0}; }));
  for (const double length : {0.0, 0.98, 1.02}) EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.toward_right = {length, 0, 0}; }));
  EXPECT_TRUE(are_taken([](EyesState& eyes) { eyes.toward_right = {0.6, 0, -0.8}; }));
  for (const double separation : {nan, 0.0, -63.0, 39.9, 90.1})
    EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.eye_separation_mm = separation; })) << separation;
  for (const double separation : {40.0, 90.0})
    EXPECT_TRUE(are_taken([&](EyesState& eyes) { eyes.eye_separation_mm = separation; })) << separation;
}

TEST(TrackedEyes, only_new_measurements_of_a_tracked_head_are_accepted) {
  using ipc::EyesState;
  for (const ipc::EyesPhase phase : {ipc::EyesPhase::none, ipc::EyesPhase::absent, ipc::EyesPhase::silent, ipc::EyesPhase::searching})
    EXPECT_FALSE(are_taken([&](EyesState& eyes) { eyes.phase = phase; })) << ipc::name(phase);
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.measured_ns = kStart - kMillisecondNs; })) << "older than the last one";
  EXPECT_TRUE(are_taken([](EyesState& eyes) { eyes.measured_ns += 49 * kMillisecondNs; })) << "clocks are read one after the other";
  EXPECT_FALSE(are_taken([](EyesState& eyes) { eyes.measured_ns += 51 * kMillisecondNs; })) << "of the future";
}

TEST(TrackedEyes, depth_never_rises_faster_than_its_limit_after_a_partial_fade) {
  World world(prism_mask());
  allow_stereo(world);
  const std::int64_t rise_ns = world.eyes.limits().rise_ns;
  for (const std::int64_t pause_ms : {20, 60, 300}) {
    world.run_until_stereo();
    world.reading.prism->stereo_allowed = false;
    world.run_ms(pause_ms);
    world.reading.prism->stereo_allowed = true;
  }
  world.run_until_stereo();
  for (std::size_t i = 1; i < world.pictures.size(); ++i) {
    const Shown &before = world.pictures[i - 1], &now = world.pictures[i];
    // The kiosk doesn't know the phase of the refreshes: a picture may light up a period later than predicted.
    const double max_rise = static_cast<double>(now.lit_ns - before.lit_ns + 17 * kMillisecondNs) / static_cast<double>(rise_ns);
    EXPECT_LE(now.seen.depth_share - before.seen.depth_share, max_rise + 1e-9) << i;
  }
}

/// A viewer in the middle and a mask that follows; look() is called every 17 ms for pictures seen 20 to 37 ms later.
class Looks {
 public:
  explicit Looks(const FollowOptions& options = prism_mask()) : eyes(options) {
    reading = eyes_measured_at(kStart);
    reading.prism.emplace();
    reading.prism->stereo_allowed = true;
  }
  LitTime lit() const { return {now + 20 * kMillisecondNs, now + 37 * kMillisecondNs}; }
  const SeenFrom& look() {
    now += 17 * kMillisecondNs;
    if (measures) reading.eyes->measured_ns = now;
    reading.eyes->time_ns = now;
    if (reading.prism) reading.prism->time_ns = reading.prism->measured_ns = now;
    return seen = eyes.look(reading, now, lit());
  }
  void look_for_ms(std::int64_t ms) {
    for (const std::int64_t until = now + ms * kMillisecondNs; now < until;) look();
  }

  TrackedEyes eyes;
  DeviceReading reading;
  SeenFrom seen;
  std::int64_t now = kStart;
  bool measures = true;
};

TEST(TrackedEyes, the_picture_moves_gradually_to_eyes_that_come_back_elsewhere) {
  Looks looks;
  looks.look_for_ms(500);
  EXPECT_EQ(looks.seen.depth_share, 1);
  looks.measures = false;
  looks.look_for_ms(120);
  looks.measures = true;
  looks.reading.eyes->between_eyes_mm[0] = 100;
  double before = looks.seen.between_eyes_mm.x();
  for (int i = 0; i < 40; ++i) {
    const SeenFrom& seen = looks.look();
    EXPECT_LT(seen.between_eyes_mm.x() - before, 30) << "no jump";
    if (seen.between_eyes_mm.x() < 70) {
      EXPECT_EQ(seen.depth_share, 0) << "30 mm beside the eyes";
    }
    before = seen.between_eyes_mm.x();
  }
  EXPECT_NEAR(before, 100, 2.1);
}

TEST(TrackedEyes, a_very_slow_tracker_does_not_extend_depth) {
  World world(prism_mask());
  allow_stereo(world);
  world.reading.eyes->lost_after_ns = 60'000 * kMillisecondNs;
  world.run_until_stereo();
  world.tracker_sees = false;
  world.run_ms(2'000);
  world.close_pictures();
  EXPECT_EQ(world.seen.depth_share, 0);
  EXPECT_LE(depth_ended_ns(world) - world.last_measured_ns, kMaxDepthAgeNs + 500 * kMillisecondNs);
}

TEST(TrackedEyes, a_measured_eye_separation_replaces_the_trackers) {
  for (const bool was_measured : {false, true}) {
    FollowOptions options;
    if (was_measured) options.eye_separation_mm = 58;
    Looks looks(options);
    looks.reading.eyes->eye_separation_mm = 68;
    looks.look_for_ms(500);
    EXPECT_NEAR(looks.seen.eye_separation_mm, was_measured ? 58 : 68, 1) << "within the zone in which it is constant";
  }
}

TEST(TrackedEyes, depth_fades_each_time_the_mask_stops) {
  Looks looks;
  for (int round = 0; round < 3; ++round) {
    looks.reading.prism->stereo_allowed = true;
    looks.look_for_ms(500);
    EXPECT_EQ(looks.seen.depth_share, 1);
    looks.reading.prism->stereo_allowed = false;
    int between = 0;
    for (int i = 0; i < 10; ++i) {
      const double share = looks.look().depth_share;
      between += share > 0 && share < 1 ? 1 : 0;
    }
    EXPECT_GE(between, 3) << "of the five pictures in 80 ms, round " << round;
    EXPECT_EQ(looks.seen.depth_share, 0);
  }
}

TEST(TrackedEyes, exactly_the_pictures_seen_during_an_announced_move_back_are_mono) {
  for (const bool allowed_meanwhile : {true, false}) {
    Looks looks;
    looks.look_for_ms(500);
    ipc::PrismState& mask = *looks.reading.prism;
    mask.mono_from_ns = looks.now + 203 * kMillisecondNs;
    mask.mono_until_ns = mask.mono_from_ns + 120 * kMillisecondNs;
    for (int i = 0; i < 40; ++i) {
      const bool moves = looks.now + 17 * kMillisecondNs >= mask.mono_from_ns && looks.now + 17 * kMillisecondNs < mask.mono_until_ns;
      mask.stereo_allowed = allowed_meanwhile || !moves;
      const double share = looks.look().depth_share;
      const LitTime lit = looks.lit();
      const bool touches = lit.until_ns > mask.mono_from_ns && lit.from_ns < mask.mono_until_ns;
      if (touches) {
        EXPECT_EQ(share, 0) << i;
      } else if (allowed_meanwhile) {
        EXPECT_GT(share, 0) << i;
      }
    }
    EXPECT_EQ(looks.seen.depth_share, 1);
  }
}

TEST(TrackedEyes, a_move_back_announced_too_late_ends_depth_at_once) {
  Looks looks;
  looks.look_for_ms(500);
  ipc::PrismState& mask = *looks.reading.prism;
  mask.stereo_allowed = false;
  mask.mono_from_ns = looks.now;
  mask.mono_until_ns = looks.now + 120 * kMillisecondNs;
  EXPECT_EQ(looks.look().depth_share, 0) << "no fade while the mask moves back";
}

TEST(TrackedEyes, another_display_begins_in_mono_at_its_resting_position) {
  Looks looks;
  looks.reading.eyes->between_eyes_mm = {200, 0, 650};
  looks.look_for_ms(1000);
  EXPECT_EQ(looks.seen.depth_share, 1);
  EXPECT_NEAR(looks.seen.between_eyes_mm.x(), 200, 3);
  FollowOptions other;
  other.resting_mm = {0, 50, 700};
  looks.eyes.set_options(other);
  looks.look();
  EXPECT_EQ(looks.seen.depth_share, 0);
  EXPECT_LT((looks.seen.between_eyes_mm - other.resting_mm).norm(), 1) << "and moves to the eyes from there";
  looks.look_for_ms(1000);
  EXPECT_EQ(looks.seen.depth_share, 1);
}

TEST(TrackedEyes, a_page_without_a_state_of_the_mask_gives_no_depth) {
  Looks looks;
  const std::optional<ipc::PrismState> mask = std::exchange(looks.reading.prism, std::nullopt);
  looks.look_for_ms(1000);
  EXPECT_EQ(looks.seen.depth_share, 0);
  EXPECT_FALSE(looks.seen.mask_mm) << "the ideal position for these eyes";
  looks.reading.prism = mask;
  looks.look_for_ms(500);
  EXPECT_EQ(looks.seen.depth_share, 1);
  looks.reading.prism.reset();
  int between = 0;
  for (double before = 1; looks.look().depth_share > 0; before = looks.seen.depth_share) {
    ASSERT_LE(looks.seen.depth_share, before);
    ++between;
  }
  EXPECT_GE(between, 3) << "a fade ...";
  EXPECT_LE(between, 6) << "... of 80 ms";
}

/// Also if pictures take so long that no time is left for a fade.
TEST(TrackedEyes, depth_never_rises_while_nothing_is_measured) {
  for (std::int64_t ahead_ms = 20; ahead_ms <= 400; ahead_ms += 20) {
    TrackedEyes eyes(prism_mask());
    DeviceReading reading = eyes_measured_at(kStart);
    reading.prism.emplace().stereo_allowed = true;
    std::int64_t now = kStart;
    const auto share = [&](std::int64_t measured_ns) {
      now += 17 * kMillisecondNs;
      reading.eyes->time_ns = reading.prism->time_ns = reading.prism->measured_ns = now;
      reading.eyes->measured_ns = measured_ns;
      const std::int64_t until = now + ahead_ms * kMillisecondNs;
      return eyes.look(reading, now, {until - 17 * kMillisecondNs, until}).depth_share;
    };
    for (int i = 0; i < 60; ++i) share(now + 17 * kMillisecondNs);
    const std::int64_t measured = now, deadline = measured + eyes.limits().mono_after_ns;
    for (double before = 1; now < measured + 500 * kMillisecondNs;) {
      const double next = share(measured);
      EXPECT_LE(next, before) << ahead_ms << " ms ahead, " << (now - measured) / kMillisecondNs << " ms after";
      EXPECT_GE(next, 0);
      // The picture may stay until the eyes are known to be lost.
      const bool known = now - measured > eyes.limits().lost_after_ns;
      if (known && now + ahead_ms * kMillisecondNs >= deadline) {
        EXPECT_EQ(next, 0) << ahead_ms << " ms ahead";
      }
      before = next;
    }
  }
}

TEST(TrackedEyes, another_display_begins_in_mono_even_if_the_mask_stopped_long_ago) {
  Looks looks;
  looks.look_for_ms(500);
  looks.reading.prism->stereo_allowed = false;
  looks.look();
  for (const bool movable : {true, false, true}) {
    FollowOptions other;
    other.movable_mask = movable;
    looks.eyes.set_options(other);
    looks.look();
    EXPECT_EQ(looks.seen.depth_share, 0) << movable;
    looks.look_for_ms(500);
    EXPECT_EQ(looks.seen.depth_share, movable ? 0 : 1);
  }
  looks.reading.prism->stereo_allowed = true;
  looks.look_for_ms(500);
  EXPECT_EQ(looks.seen.depth_share, 1);
}

TEST(TrackedEyes, the_mask_is_at_its_measured_or_its_ideal_position) {
  TrackedEyes eyes(prism_mask());
  DeviceReading reading;
  ipc::PrismState& mask = reading.prism.emplace();
  const auto mask_mm = [&](double place_mm) {
    mask.position_mm = mask.goal_mm = place_mm;
    return eyes.look(reading, kStart, {kStart + 20 * kMillisecondNs, kStart + 37 * kMillisecondNs}).mask_mm;
  };
  EXPECT_FALSE(mask_mm(0.3)) << "never measured";
  mask.time_ns = mask.measured_ns = kStart;
  EXPECT_FALSE(mask_mm(std::nan("")));
  EXPECT_EQ(mask_mm(0.3), 0.3);
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) EXPECT_EQ(mask_mm(wrong), 0.3);
  EXPECT_EQ(mask_mm(0.304), 0.3) << "a smaller movement is ignored";
  EXPECT_EQ(mask_mm(0.306), 0.306);
}

TEST(TrackedEyes, the_position_never_jumps_and_returns_to_rest_without_a_viewer) {
  const HeadMotion motion(MotionKind::still, 2, Vector3d(180, -40, 720));
  World world(prism_mask(), motion);
  allow_stereo(world);
  world.run_ms(2000);
  EXPECT_LT((world.seen.between_eyes_mm - motion.between_eyes_mm(2)).norm(), 8);
  world.tracker_sees = false;
  world.run_ms(6000);
  EXPECT_LT((world.seen.between_eyes_mm - Vector3d(0, 0, 650)).norm(), 0.1);
  world.tracker_sees = true;
  world.run_ms(3000);
  EXPECT_LT((world.seen.between_eyes_mm - motion.between_eyes_mm(2)).norm(), 8);
  for (std::size_t i = 1; i < world.pictures.size(); ++i) {
    const double step = (world.pictures[i].seen.between_eyes_mm - world.pictures[i - 1].seen.between_eyes_mm).norm();
    const double seconds = static_cast<double>(world.pictures[i].lit_ns - world.pictures[i - 1].lit_ns) * 1e-9;
    EXPECT_LT(step, std::max(10.0, seconds * 6000)) << i;
    if (world.pictures[i].seen.depth_share > 0.5) {
      EXPECT_LT(step, 30) << i;
    }
  }
}

TEST(TrackedEyes, depth_waits_until_the_picture_is_at_the_eyes) {
  World world(prism_mask(), HeadMotion(MotionKind::still, 2, Vector3d(200, 0, 650)));
  allow_stereo(world);
  world.run_ms(1500);
  for (const Shown& shown : world.pictures)
    if (shown.seen.depth_share > 0) {
      EXPECT_LT((shown.seen.between_eyes_mm - world.head_at(shown.lit_ns)).norm(), 35);
    }
  EXPECT_EQ(world.seen.depth_share, 1);
}

TEST(TrackedEyes, the_mask_is_predicted_to_the_time_of_light) {
  World world(prism_mask());
  allow_stereo(world);
  ipc::PrismState& mask = *world.reading.prism;
  mask.position_mm = 0.1;
  mask.lag_ns = 20 * kMillisecondNs;
  mask.goal_mm = 0.14;
  mask.goal_velocity_mm_s = 2;
  world.run_ms(100);
  ASSERT_TRUE(world.seen.mask_mm.has_value());
  EXPECT_GT(*world.seen.mask_mm, 0.15) << "about 40 ms ahead at 2 mm/s";
  EXPECT_LT(*world.seen.mask_mm, 0.3);
}

TEST(TrackedEyes, glasses_keep_their_depth_without_eyes) {
  FollowOptions options;
  options.mono_without_eyes = options.movable_mask = false;
  World world(options, HeadMotion(MotionKind::still, 2, Vector3d(150, 0, 700)));
  world.run_ms(1000);
  EXPECT_EQ(world.seen.depth_share, 1);
  EXPECT_NEAR(world.seen.between_eyes_mm.x(), 150, 8);
  EXPECT_FALSE(world.seen.mask_mm);
  world.tracker_sees = false;
  world.run_ms(6000);
  EXPECT_EQ(world.seen.depth_share, 1);
  EXPECT_NEAR(world.seen.between_eyes_mm.x(), 0, 0.1) << "not at the last position of the head";
}

TEST(TrackedEyes, fixed_eyes_keep_depth_whatever_the_daemon_reports) {
  FollowOptions options;
  options.follow = options.movable_mask = false;
  options.resting_mm = {30, 20, 600};
  World world(options, HeadMotion(MotionKind::sway, 2));
  world.run_ms(1000);
  EXPECT_EQ(world.seen.depth_share, 1);
  EXPECT_EQ(world.seen.between_eyes_mm, Vector3d(30, 20, 600));
  EXPECT_EQ(world.pictures.size(), 1u);
}

}  // namespace
}  // namespace prismesh::kiosk::stereo
