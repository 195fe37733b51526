#include "drivers/eye_tracker/opentrack/tracker.h"

#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/opentrack/simulator.h"

namespace prismesh::drivers::eye_tracker::opentrack {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class QueuedPort final : public port::DatagramPort {
 public:
  port::Datagram receive(std::span<std::byte> to) override {
    if (gone) return {.status = port::PortStatus::gone};
    if (waiting.empty()) return {};
    const auto datagram = waiting.front();
    waiting.pop_front();
    const std::size_t bytes = std::min(to.size(), datagram.size());
    std::copy_n(datagram.begin(), bytes, to.begin());
    return {.arrived = true, .bytes = bytes, .full_length = datagram.size()};
  }
  void discard_input() override { waiting.clear(); }
  int last_error() const override { return 0; }
  void add(std::span<const std::byte> datagram) { waiting.emplace_back(datagram.begin(), datagram.end()); }
  void add(const Pose& pose) { add(encode(pose)); }

  std::deque<std::vector<std::byte>> waiting;
  bool gone = false;
};

Pose at(double x_cm) { return {{x_cm, 0, 65}, 0, 0, 0}; }

TEST(OpentrackTracker, the_newest_datagram_wins) {
  QueuedPort port;
  OpentrackTracker tracker(port, {.latency_ns = 30 * kMs, .offset_mm = {1, 2, 3}});
  EXPECT_FALSE(tracker.synchronised());
  for (int i = 1; i <= 3; ++i) port.add(at(i));
  const auto polled = tracker.poll(100 * kMs);
  ASSERT_TRUE(polled.fresh);
  EXPECT_TRUE(polled.sample.between_eyes_mm.isApprox(Eigen::Vector3d(-29, 2, 653)));
  EXPECT_EQ(polled.sample.measured_ns, 70 * kMs);
  EXPECT_FALSE(polled.sample.doubtful);
  EXPECT_TRUE(tracker.synchronised());
  EXPECT_EQ(tracker.counts().records, 3u);
  EXPECT_FALSE(tracker.poll(105 * kMs).fresh);
}

TEST(OpentrackTracker, a_repeated_pose_is_no_sample) {
  QueuedPort port;
  OpentrackTracker tracker(port, {});
  port.add(at(1));
  EXPECT_TRUE(tracker.poll(0).fresh);
  for (int i = 1; i <= 200; ++i) {
    port.add(at(1));
    EXPECT_FALSE(tracker.poll(i * 4 * kMs).fresh);
  }
  EXPECT_TRUE(tracker.synchronised()) << "somebody sends, though it sees no head";
  EXPECT_EQ(tracker.counts().without_head, 200u);
  port.add(at(1.001));
  EXPECT_TRUE(tracker.poll(900 * kMs).fresh);
}

TEST(OpentrackTracker, drops_and_counts_what_is_no_pose_or_no_viewer) {
  QueuedPort port;
  OpentrackTracker tracker(port, {});
  port.add(std::vector<std::byte>(47));
  port.add(std::vector<std::byte>(49));
  port.add(std::vector<std::byte>(5000));
  port.add(std::vector<std::byte>());
  EXPECT_FALSE(tracker.poll(0).fresh);
  EXPECT_FALSE(tracker.synchronised());
  EXPECT_EQ(tracker.counts().bytes_skipped, 47u + 49 + 5000);
  port.add(Pose{{0, 0, -65}, 0, 0, 0});  // behind the screen
  port.add(Pose{{1e6, 0, 65}, 0, 0, 0});
  EXPECT_FALSE(tracker.poll(0).fresh);
  EXPECT_EQ(tracker.counts().rejected, 2u);
}

TEST(OpentrackTracker, counts_silence_once) {
  QueuedPort port;
  OpentrackTracker tracker(port, {});
  port.add(at(1));
  tracker.poll(0);
  tracker.poll(500 * kMs);
  EXPECT_TRUE(tracker.synchronised());
  tracker.poll(505 * kMs);
  tracker.poll(510 * kMs);
  EXPECT_FALSE(tracker.synchronised());
  EXPECT_EQ(tracker.counts().resyncs, 1u);
  port.add(at(1));
  EXPECT_TRUE(tracker.poll(600 * kMs).fresh) << "after a silence the same pose is news";
}

TEST(OpentrackTracker, a_flood_takes_more_than_one_poll) {
  QueuedPort port;
  OpentrackTracker tracker(port, {});
  for (int i = 0; i < 1000; ++i) port.add(at(0.01 * i));
  tracker.poll(0);
  EXPECT_GT(port.waiting.size(), 900u);
  for (int i = 0; i < 20; ++i) tracker.poll(i * kMs);
  EXPECT_TRUE(port.waiting.empty());
}

TEST(OpentrackTracker, reports_a_port_that_is_gone) {
  QueuedPort port;
  OpentrackTracker tracker(port, {});
  port.gone = true;
  EXPECT_EQ(tracker.poll(0).status, port::PortStatus::gone);
}

TEST(OpentrackStation, follows_the_simulated_webcam_and_shows_its_loss_as_age) {
  QueuedPort port;
  const HeadSource head = [](double seconds) {
    SimulatedHead there;
    there.between_eyes_mm = {100 * std::sin(seconds), 20, 600};
    there.toward_right = Eigen::Vector3d(std::cos(0.3 * std::sin(seconds)), std::sin(0.3 * std::sin(seconds)), 0);
    there.visible = seconds < 3 || seconds > 5;
    return there;
  };
  OpentrackSimulator device([&](std::span<const std::byte> datagram) { port.add(datagram); }, head,
                            {.noise_mm = 0, .noise_degrees = 0, .latency_ns = 40 * kMs});
  OpentrackTracker tracker(port, {.latency_ns = 40 * kMs});
  int fresh = 0, fresh_while_away = 0;
  for (std::int64_t now = 0; now < 8'000 * kMs; now += 5 * kMs) {
    device.run_until(now);
    const auto polled = tracker.poll(now);
    if (!polled.fresh) continue;
    ++fresh;
    const double seconds = static_cast<double>(polled.sample.measured_ns) * 1e-9;
    const SimulatedHead truth = head(seconds);
    if (seconds > 3.01 && seconds < 4.99) ++fresh_while_away;
    EXPECT_LE((polled.sample.between_eyes_mm - truth.between_eyes_mm).norm(), 100 * 0.0055) << "at most one poll late";
    EXPECT_LE((polled.sample.toward_right - truth.toward_right).norm(), 0.002);
  }
  EXPECT_NEAR(fresh, 6 * 30, 3);
  EXPECT_EQ(fresh_while_away, 0);
  EXPECT_TRUE(tracker.synchronised());
  EXPECT_NEAR(static_cast<double>(device.datagrams_sent()), 8 * 120, 2);
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::opentrack
