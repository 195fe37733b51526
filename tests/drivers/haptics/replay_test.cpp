// Records of a safety that was played with, as text and run again.
#include "drivers/haptics/replay.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/seed.h"

namespace prismesh::drivers::haptics {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;

/// Plays hand and loop, and keeps the ticks as the pen's process does.
class Player {
 public:
  Player() : safety_({}, Eigen::Vector3d::Constant(6)) { record_.limits = {HapticLimits{}.max_newton, {6, 6, 6}}; }

  struct Event {
    bool rearm = false, io_error = false, ready = true;
    std::int64_t gap_ns = kTickNs;
    Eigen::Vector3d jump_mm = Eigen::Vector3d::Zero();
  };
  void tick(const Event& event) {
    now_ns_ += event.gap_ns;
    const double s = static_cast<double>(now_ns_) * 1e-9;
    offset_mm_ += event.jump_mm;
    PenTick tick{};
    tick.now_ns = now_ns_;
    const Eigen::Vector3d at = offset_mm_ + Eigen::Vector3d(12 * std::sin(7 * s), 5 * std::cos(3 * s), 0.01 * noise_(random_));
    Eigen::Map<Eigen::Vector3d>{tick.position_mm} = at;
    tick.measured_ns = now_ns_ - 200'000;
    Eigen::Map<Eigen::Vector3d>{tick.parts[0].newton} = Eigen::Vector3d(at.x() > 4 ? -0.4 * (at.x() - 4) : 0, 0, 0);
    tick.parts[0].from_ns = now_ns_ - 30 * kTickNs;
    Eigen::Map<Eigen::Vector3d>{tick.parts[2].newton} = Eigen::Vector3d(-0.02 * std::cos(7 * s), 0, 0.001 * noise_(random_));
    tick.parts[2].from_ns = 0;
    tick.ready = event.ready;
    tick.io_error = event.io_error;
    tick.rearm = event.rearm;
    tick.begins = record_.ticks.empty();
    tick.element = -1;
    std::array<ForcePart, kForceKinds> parts;
    for (std::size_t k = 0; k < kForceKinds; ++k)
      parts[k] = {Eigen::Map<const Eigen::Vector3d>(tick.parts[k].newton), tick.parts[k].from_ns, k == 2};
    SafetyInput input;
    input.now_ns = tick.now_ns;
    input.position_mm = at;
    input.measured_ns = tick.measured_ns;
    input.ready = event.ready;
    input.io_error = event.io_error;
    input.parts = parts;
    input.rearm = event.rearm;
    const SafetyOutput output = safety_.step(input);
    tick.phase = static_cast<std::uint8_t>(output.record.phase);
    tick.fault = static_cast<std::uint8_t>(output.record.fault);
    tick.tank_limited = output.tank_limited;
    Eigen::Map<Eigen::Vector3d>{tick.newton} = output.newton;
    record_.ticks.push_back(tick);
  }
  void play(int ms) {
    for (int i = 0; i < ms; ++i) tick({});
  }
  /// At rest, armed, at work, latched by a jump, at rest, armed again, and a line that fails.
  static PenRecord session() {
    Player player;
    player.play(600);
    // Arming is refused while the pen touches something.
    for (int i = 0; i < 2000 && player.phase() != SafetyPhase::armed; ++i) player.tick({.rearm = i % 2 == 0});
    player.play(1500);
    player.tick({.jump_mm = {30, 0, 0}});
    player.play(100);
    player.tick({.jump_mm = {-30, 0, 0}});
    player.play(700);
    for (int i = 0; i < 2000 && player.phase() != SafetyPhase::armed; ++i) player.tick({.rearm = i % 2 == 0});
    player.play(1200);
    player.tick({.io_error = true});
    player.play(50);
    return player.record_;
  }
  SafetyPhase phase() const { return safety_.record().phase; }

 private:
  Safety safety_;
  PenRecord record_;
  std::mt19937 random_{test::seed(3)};
  std::uniform_real_distribution<double> noise_{-1, 1};
  std::int64_t now_ns_ = 5'000 * kTickNs;
  Eigen::Vector3d offset_mm_ = Eigen::Vector3d::Zero();
};

std::string text_of(const PenRecord& record) {
  std::string text = pen_record_header(record.limits);
  for (const PenTick& tick : record.ticks) text += pen_record_line(tick);
  return text;
}

TEST(PenRecord, is_the_same_bytes_after_its_text) {
  PenRecord record = Player::session();
  record.ticks[3].position_mm[1] = std::numeric_limits<double>::quiet_NaN();
  record.ticks[4].newton[2] = -std::numeric_limits<double>::infinity();
  record.ticks[5].newton[0] = -0.0;
  record.ticks[6].parts[4].from_ns = std::numeric_limits<std::int64_t>::min();
  record.ticks[7].position_mm[0] = std::numeric_limits<double>::denorm_min();
  const std::string text = text_of(record);
  const auto again = parse_pen_record(text, "a.record");
  ASSERT_TRUE(again) << again.error().text();
  ASSERT_EQ(again->ticks.size(), record.ticks.size());
  for (std::size_t t = 0; t < record.ticks.size(); ++t) ASSERT_EQ(pen_record_line(again->ticks[t]), pen_record_line(record.ticks[t]));
  EXPECT_EQ(text_of(*again), text);
  for (std::size_t t = 8; t < 100; ++t) EXPECT_EQ(std::memcmp(&again->ticks[t], &record.ticks[t], sizeof(PenTick)), 0);
}

TEST(PenRecord, says_where_a_text_is_wrong) {
  const PenRecord record = Player::session();
  const std::string text = text_of(record);
  const auto refusal = [](const std::string& other) {
    const auto parsed = parse_pen_record(other, "a.record");
    return parsed ? "" : parsed.error().text();
  };
  EXPECT_EQ(refusal(""), "a.record:1: this is no record of a pen: it doesn't begin with \"prismesh-pen-record 1\"");
  EXPECT_EQ(refusal("prismesh-pen-record 2\n" + text.substr(text.find('\n') + 1)).substr(0, 11), "a.record:1:");
  EXPECT_EQ(refusal("prismesh-pen-record 1\nlimits 8 6 6\n").substr(0, 11), "a.record:2:");
  const std::string line = pen_record_line(record.ticks[9]);
  EXPECT_EQ(refusal(text + line.substr(0, line.size() - 5) + "x\n").substr(0, 9), "a.record:");
  EXPECT_NE(refusal(text + "1 2 3\n").find("the column position_mm_z is missing"), std::string::npos);
  EXPECT_NE(refusal(text + line.substr(0, line.size() - 1) + " 7\n").find("more columns"), std::string::npos);
  // What a program that was killed has left.
  const auto cut = parse_pen_record(text.substr(0, text.size() - 20), "a.record");
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->ticks.size(), record.ticks.size() - 1);
}

TEST(Replay, gives_the_same_decisions_and_forces_bit_for_bit) {
  const PenRecord record = Player::session();
  const ReplayReport report = replay(record);
  EXPECT_EQ(report.differing, 0u);
  EXPECT_EQ(report.decisions_compared, record.ticks.size());
  EXPECT_EQ(report.forces_compared, record.ticks.size());
  EXPECT_GT(report.max_newton, 0.5);
  std::vector<SafetyPhase> phases;
  for (const auto& change : report.changes) phases.push_back(change.phase);
  EXPECT_EQ(phases,
            (std::vector{SafetyPhase::disarmed, SafetyPhase::armed, SafetyPhase::latched, SafetyPhase::armed, SafetyPhase::latched}));
  EXPECT_EQ(report.changes[2].fault, SafetyFault::jump);
  EXPECT_EQ(report.changes[4].fault, SafetyFault::io_error);
}

TEST(Replay, finds_a_force_that_differs_by_an_ulp) {
  PenRecord record = Player::session();
  std::size_t pushed = 0;
  while (record.ticks[pushed].newton[0] == 0) ++pushed;
  record.ticks[pushed].newton[0] = std::nextafter(record.ticks[pushed].newton[0], 9.0);
  const ReplayReport report = replay(record);
  EXPECT_EQ(report.differing, 1u);
  EXPECT_EQ(report.first_difference, pushed);
}

TEST(Replay, finds_a_fault_that_was_missed) {
  PenRecord record = Player::session();
  const ReplayReport whole = replay(record);
  const std::size_t jump = whole.changes[2].tick;
  for (std::size_t t = jump; t < whole.changes[3].tick; ++t) record.ticks[t].phase = static_cast<std::uint8_t>(SafetyPhase::armed);
  const ReplayReport report = replay(record);
  EXPECT_EQ(report.first_difference, jump);
}

/// As the pen's process keeps only the last seconds, a record may begin anywhere.
TEST(Replay, of_a_record_that_begins_armed_decides_on_faults_and_waits_with_forces) {
  const PenRecord whole = Player::session();
  const ReplayReport of_whole = replay(whole);
  const std::size_t armed = of_whole.changes[1].tick, jump = of_whole.changes[2].tick, rearmed = of_whole.changes[3].tick;
  PenRecord record{whole.limits, {whole.ticks.begin() + static_cast<std::ptrdiff_t>(armed) + 400, whole.ticks.end()}};
  ReplayReport report = replay(record);
  EXPECT_EQ(report.differing, 0u);
  EXPECT_GT(report.decisions_compared, record.ticks.size() - 100);
  EXPECT_EQ(report.forces_compared, whole.ticks.size() - rearmed);
  // Break the fault: the jump isn't answered.
  record.ticks[jump - armed - 400].phase = static_cast<std::uint8_t>(SafetyPhase::armed);
  report = replay(record);
  EXPECT_EQ(report.first_difference, jump - armed - 400);
}

TEST(Replay, of_a_record_that_begins_latched_compares_from_the_first_tick) {
  const PenRecord whole = Player::session();
  const std::size_t jump = replay(whole).changes[2].tick;
  const PenRecord record{whole.limits, {whole.ticks.begin() + static_cast<std::ptrdiff_t>(jump) + 50, whole.ticks.end()}};
  const ReplayReport report = replay(record);
  EXPECT_EQ(report.differing, 0u);
  EXPECT_EQ(report.decisions_compared, record.ticks.size());
  EXPECT_GT(report.forces_compared, 1000u);
}

/// What a running pen recorded: the safety decides as it did then. A record of a fault in the field goes into this folder.
TEST(Replay, of_each_record_of_a_fault_decides_as_it_did) {
  int records = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / "tests/drivers/haptics/records")) {
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto record = parse_pen_record(text, entry.path().string());
    ASSERT_TRUE(record) << record.error().text();
    const ReplayReport report = replay(*record);
    EXPECT_EQ(report.differing, 0u) << entry.path() << ", tick " << report.first_difference.value_or(0);
    EXPECT_GT(report.decisions_compared, 0u) << entry.path();
    EXPECT_EQ(report.changes.back().phase, SafetyPhase::latched) << entry.path();
    ++records;
  }
  EXPECT_GT(records, 0);
}

TEST(Replay, of_nothing_and_of_nonsense_ends) {
  EXPECT_EQ(replay({}).changes.size(), 0u);
  PenRecord record;
  record.ticks.resize(100);
  std::mt19937 random(test::seed(4));
  for (PenTick& tick : record.ticks)
    for (std::size_t at = 0; at + 4 <= sizeof tick; at += 4) {
      const std::uint32_t word = static_cast<std::uint32_t>(random());
      std::memcpy(reinterpret_cast<char*>(&tick) + at, &word, sizeof word);
    }
  (void)replay(record);
  for (PenTick& tick : record.ticks) tick.begins = 0;
  (void)replay(record);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
