// The dialogue between station and tracker, byte by byte.
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/dynasight/tracker.h"

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::int64_t kMillisecondNs = 1'000'000;

/// A port whose other end is the test.
class ScriptedPort final : public port::BytePort {
 public:
  port::PortCount read(std::span<std::byte> to) override {
    if (gone) return {0, port::PortStatus::gone};
    std::size_t got = 0;
    for (; got < to.size() && !arrived.empty(); ++got) {
      to[got] = arrived.front();
      arrived.pop_front();
    }
    return {got, port::PortStatus::ok};
  }
  port::PortCount write(std::span<const std::byte> from) override {
    if (gone) return {0, port::PortStatus::gone};
    const std::size_t taken = std::min(from.size(), room);
    for (std::size_t i = 0; i < taken; ++i) said.push_back(static_cast<char>(from[i]));
    room -= taken;
    return {taken, taken == from.size() ? port::PortStatus::ok : port::PortStatus::full};
  }
  void discard_input() override { arrived.clear(); }
  bool set_baud(int) override { return true; }
  int last_error() const override { return 0; }
  std::string take_said() { return std::exchange(said, {}); }

  std::deque<std::byte> arrived;
  std::string said;
  std::size_t room = 1000;
  bool gone = false;
};

struct Line {
  std::int64_t at_ms;
  std::vector<RecordBytes> device = {};  ///< arrives before the poll at that time
  std::string station = "";              ///< what the station sends in that poll
  std::optional<double> x_mm = {};       ///< x of the fresh sample
  bool doubtful = false;
};

RecordBytes at(double x_mm, Status status = Status::track) { return encode(record_for({x_mm, 40, 650}, status)); }

void expect_dialogue(const std::vector<Line>& lines, const DynasightTracker::Options& options) {
  ScriptedPort port;
  DynasightTracker tracker(port, options);
  for (const Line& line : lines) {
    for (const RecordBytes& record : line.device) port.arrived.insert(port.arrived.end(), record.begin(), record.end());
    const EyeTracker::Polled polled = tracker.poll(line.at_ms * kMillisecondNs);
    EXPECT_EQ(port.take_said(), line.station) << "at " << line.at_ms << " ms";
    EXPECT_EQ(polled.fresh, line.x_mm.has_value()) << "at " << line.at_ms << " ms";
    if (!polled.fresh || !line.x_mm) continue;
    EXPECT_NEAR(polled.sample.between_eyes_mm.x(), *line.x_mm, 0.051) << "at " << line.at_ms << " ms";
    EXPECT_EQ(polled.sample.doubtful, line.doubtful) << "at " << line.at_ms << " ms";
    EXPECT_EQ(polled.sample.toward_right, Eigen::Vector3d::UnitX());
  }
}

TEST(DynasightDialogue, interrupts_a_d4d_and_starts_its_stream) {
  expect_dialogue(
      {{0, {}, "\x03\x03\x03"},
       {5, {at(9), at(9), at(9), at(9), at(9), at(8)}, ""},  // from before the restart: not a sample, however well the records agree
       {45, {}, ""},
       {50, {}, "0"},
       {70, {at(1)}},
       {87, {at(2)}},
       {103, {at(3)}},
       {120, {at(4)}},  // four agree: synchronised, and the next one is plausible
       {137, {at(5)}, "", 5},
       {153, {at(6, Status::caution)}, "", 6, true},
       {170, {at(6, Status::coast)}, "", 6, true},
       {187, {at(0, Status::search)}},
       {203, {at(7)}},  // the head is back; a second record has to confirm it
       {220, {at(8)}, "", 8}},
      {});
}

TEST(DynasightDialogue, starts_a_dynasights_stream_with_its_own_command) {
  expect_dialogue({{0, {}, "\x03\x03\x03"}, {50, {}, "V"}}, {.dialect = settings::TrackerDialect::dynasight});
}

TEST(DynasightDialogue, polled_mode_requests_one_record_at_a_time) {
  expect_dialogue({{0, {}, "\x03\x03\x03"},
                   {50, {}, "4\x11"},
                   {55, {}, ""},
                   {60, {at(1)}, "\x11"},
                   {65, {at(2)}, "\x11"},
                   {70, {at(3)}, "\x11"},
                   {75, {at(4)}, "\x11"},
                   {80, {at(5)}, "\x11", 5},
                   {180, {}, ""},
                   {185, {}, "\x11"},  // no answer for 100 ms: request or answer was lost
                   {190, {at(6)}, "\x11", 6}},
                  {.polled = true});
}

TEST(DynasightDialogue, retries_a_silent_device) {
  expect_dialogue({{0, {}, "\x03\x03\x03"},
                   {50, {}, "0"},
                   {550, {}, ""},
                   {555, {}, "\x03\x03\x03"},
                   {600, {}, ""},
                   {605, {}, "0"},
                   {1105, {}, ""},
                   {1110, {}, "\x03\x03\x03"}},
                  {});
}

TEST(DynasightDialogue, restarts_a_device_that_falls_silent_or_sends_noise) {
  for (const bool nonsense : {false, true}) {
    ScriptedPort port;
    DynasightTracker tracker(port, {});
    tracker.poll(0);
    tracker.poll(50 * kMillisecondNs);
    port.take_said();
    for (int i = 0; i < 6; ++i) {
      for (const std::byte byte : at(i)) port.arrived.push_back(byte);
      tracker.poll((60 + 17 * i) * kMillisecondNs);
    }
    ASSERT_TRUE(tracker.synchronised());
    std::int64_t restarted_ms = 0;
    for (std::int64_t ms = 160; ms < 1000 && restarted_ms == 0; ms += 5) {
      if (nonsense) port.arrived.insert(port.arrived.end(), 5, std::byte{'?'});
      tracker.poll(ms * kMillisecondNs);
      if (port.take_said() == "\x03\x03\x03") restarted_ms = ms;
    }
    EXPECT_GE(restarted_ms, 145 + 500);
    EXPECT_LE(restarted_ms, 145 + 510);
    EXPECT_EQ(tracker.counts().restarts, 1u);
    tracker.poll((restarted_ms + 50) * kMillisecondNs);
    EXPECT_FALSE(tracker.synchronised());
    EXPECT_EQ(tracker.counts().resyncs, 1u);
  }
}

TEST(DynasightDialogue, commands_wait_while_the_line_is_full) {
  ScriptedPort port;
  port.room = 2;
  DynasightTracker tracker(port, {});
  EXPECT_EQ(tracker.poll(0).status, port::PortStatus::ok);
  EXPECT_EQ(port.take_said(), "\x03\x03");
  port.room = 100;
  tracker.poll(5 * kMillisecondNs);
  EXPECT_EQ(port.take_said(), "\x03");
}

TEST(DynasightDialogue, reports_a_port_that_is_gone) {
  ScriptedPort port;
  DynasightTracker tracker(port, {});
  EXPECT_EQ(tracker.poll(0).status, port::PortStatus::ok);
  port.gone = true;
  EXPECT_EQ(tracker.poll(kMillisecondNs).status, port::PortStatus::gone);
}

TEST(DynasightDialogue, takes_the_newest_record_of_a_read_and_subtracts_the_time_of_the_bytes_after_it) {
  constexpr std::int64_t kByteNs = 520'833;  // at 19200 baud
  ScriptedPort port;
  DynasightTracker tracker(port, {.latency_ns = 20 * kMillisecondNs});
  tracker.poll(0);
  tracker.poll(50 * kMillisecondNs);
  const auto add_record = [&](const RecordBytes& record, std::size_t bytes = kRecordBytes) {
    port.arrived.insert(port.arrived.end(), record.begin(), record.begin() + static_cast<std::ptrdiff_t>(bytes));
  };
  for (int i = 0; i < 6; ++i) add_record(at(i));
  auto polled = tracker.poll(200 * kMillisecondNs);
  ASSERT_TRUE(polled.fresh);
  EXPECT_EQ(polled.sample.measured_ns, 180 * kMillisecondNs);

  add_record(at(7));
  add_record(at(8), 3);  // three bytes of the next record: the previous one ended three bytes earlier
  polled = tracker.poll(220 * kMillisecondNs);
  ASSERT_TRUE(polled.fresh);
  EXPECT_NEAR(polled.sample.between_eyes_mm.x(), 7, 0.05);
  EXPECT_EQ(polled.sample.measured_ns, 200 * kMillisecondNs - 3 * kByteNs);

  const RecordBytes rest = at(8);
  port.arrived.insert(port.arrived.end(), rest.begin() + 3, rest.end());
  add_record(at(0, Status::search));  // a complete record after it: the previous one was sent a 60th of a second earlier
  polled = tracker.poll(240 * kMillisecondNs);
  ASSERT_TRUE(polled.fresh);
  EXPECT_NEAR(polled.sample.between_eyes_mm.x(), 8, 0.05);
  EXPECT_EQ(polled.sample.measured_ns, 220 * kMillisecondNs - 16'666'667);
}

TEST(DynasightDialogue, a_record_read_with_a_part_of_the_next_is_newer_than_the_previous) {
  ScriptedPort port;
  DynasightTracker tracker(port, {.latency_ns = 20 * kMillisecondNs});
  tracker.poll(0);
  tracker.poll(50 * kMillisecondNs);
  for (int i = 0; i < 6; ++i)
    for (const std::byte byte : at(i)) port.arrived.push_back(byte);
  ASSERT_EQ(tracker.poll(200 * kMillisecondNs).sample.measured_ns, 180 * kMillisecondNs);
  for (const std::byte byte : at(7)) port.arrived.push_back(byte);
  const RecordBytes begun = at(8);
  port.arrived.insert(port.arrived.end(), begun.begin(), begun.end() - 1);  // seven bytes: 3.6 ms
  const EyeTracker::Polled polled = tracker.poll(201 * kMillisecondNs);
  ASSERT_TRUE(polled.fresh);
  EXPECT_NEAR(polled.sample.between_eyes_mm.x(), 7, 0.05);
  EXPECT_EQ(polled.sample.measured_ns, 180 * kMillisecondNs + 1);
}

TEST(DynasightDialogue, ignores_records_from_before_the_dialogue) {
  ScriptedPort port;
  DynasightTracker tracker(port, {});
  for (int i = 0; i < 1'000; ++i)
    for (const std::byte byte : at(9)) port.arrived.push_back(byte);
  tracker.poll(0);
  tracker.poll(50 * kMillisecondNs);
  EXPECT_TRUE(port.arrived.empty());
  for (int i = 1; i < 8; ++i) EXPECT_FALSE(tracker.poll((50 + 5 * i) * kMillisecondNs).fresh) << "a position of unknown age";
}

TEST(DynasightDialogue, adds_the_offset_and_rejects_positions_out_of_range) {
  ScriptedPort port;
  DynasightTracker tracker(port, {.offset_mm = {10, -200, -580}});
  tracker.poll(0);
  tracker.poll(50 * kMillisecondNs);
  const auto receive_at = [&](const Eigen::Vector3d& place, std::int64_t ms) {
    for (const std::byte byte : encode(record_for(place))) port.arrived.push_back(byte);
    return tracker.poll(ms * kMillisecondNs);
  };
  for (int i = 0; i < 5; ++i) receive_at({0, 100, 700}, 60 + i);
  const auto inside = receive_at({1, 100, 700}, 80);
  ASSERT_TRUE(inside.fresh);
  EXPECT_TRUE(inside.sample.between_eyes_mm.isApprox(Eigen::Vector3d(11, -100, 120), 1e-3));
  EXPECT_FALSE(receive_at({1, 100, 670}, 90).fresh) << "90 mm from the screen: not a viewer's eyes";
  EXPECT_EQ(tracker.counts().rejected, 2u);  // plus the record that completed the lock
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::dynasight
