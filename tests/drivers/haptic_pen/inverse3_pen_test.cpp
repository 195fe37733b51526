// The driver against a service that is played by another implementation of websockets, over the loopback, in real time.
#include "drivers/haptic_pen/inverse3/inverse3_pen.h"

#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "base/clock.h"
#include "drivers/haptic_pen/device_limits.h"
#include "drivers/haptic_pen/inverse3/messages.h"
#include "tests/drivers/haptic_pen/inverse3_service.h"
#include "tests/drivers/port/allocations.h"

namespace prismesh::drivers::haptic_pen::inverse3 {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

class Inverse3 : public ::testing::Test {
 protected:
  Result<void> open(const port::UsbGate& gate = {}) {
    pen_.reset();
    link_.reset();
    Result<std::unique_ptr<ServiceLink>> link = ServiceLink::open(service_->port(), gate, 0);
    // A busy machine may not answer in time.
    for (int attempt = 0; attempt < 50 && !link && link.error().text().find("doesn't answer") != std::string::npos; ++attempt)
      link = ServiceLink::open(service_->port(), gate, 0);
    if (!link) return fail(std::move(link.error()));
    link_ = std::move(*link);
    pen_.emplace(*link_, options_);
    return {};
  }
  std::string refusal() {
    const Result<void> opened = open();
    return opened ? "opened" : opened.error().text();
  }
  /// Ticks, a millisecond or more apart, until it is so; gives up after a long time.
  bool tick_until(const std::function<bool()>& so) {
    for (int tick = 0; tick < 20'000; ++tick) {
      const std::int64_t now = clock_.now_ns();
      reading_ = pen_->read(now);
      if (reading_.fresh) pose_ = reading_.pose;
      if (sends_) pen_->send(now, {newton_, now + valid_ns_, {0, 0, 5}});
      stuck_ = pen_->is_stuck(now) || stuck_;
      if (so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  bool opens_again() {
    for (int attempt = 0; attempt < 2000; ++attempt) {
      if (open()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  MonotonicClock clock_;
  Inverse3Options options_;
  std::optional<InverseService> service_ = std::optional<InverseService>(std::in_place);
  std::unique_ptr<ServiceLink> link_;
  std::optional<Inverse3Pen> pen_;
  PenReading reading_;
  PenPose pose_;
  Eigen::Vector3d newton_ = Eigen::Vector3d::Zero();
  std::int64_t valid_ns_ = 1000 * kMs;
  bool sends_ = true, stuck_ = false;
};

TEST_F(Inverse3, tells_where_the_grip_is) {
  ASSERT_EQ(refusal(), "opened");
  EXPECT_EQ(pen_->read(clock_.now_ns()).phase, PenPhase::setting_up);
  const std::int64_t before = clock_.now_ns();
  ASSERT_TRUE(tick_until([&] { return reading_.fresh; }));
  EXPECT_EQ(reading_.phase, PenPhase::ready);
  EXPECT_EQ(reading_.trouble, PenTrouble::none);
  // 10 mm to the right, 20 mm away from the user and 30 mm up from the middle.
  EXPECT_TRUE(pose_.position_mm.isApprox(Eigen::Vector3d(10, 30, -20), 1e-9)) << pose_.position_mm.transpose();
  EXPECT_FALSE(pose_.has_orientation);
  EXPECT_GT(pose_.measured_ns, before);
  EXPECT_LT(pose_.measured_ns, clock_.now_ns());
  EXPECT_GT(pen_->round_trip_ns(), 0);
  EXPECT_EQ(pen_->advice(), "");
  EXPECT_TRUE(service_->seen().well_formed);
}

TEST_F(Inverse3, takes_orientation_and_buttons_from_the_one_grip) {
  const std::string grip = R"({"device_id":"1","state":{"orientation":{"w":0.8,"x":0,"y":0,"z":0.6},"buttons":{"a":false,"b":true}}})";
  service_->play([&](PlayedService& s) { s.grips = R"(,"wireless_verse_grip":[)" + grip + "]"; });
  ASSERT_EQ(refusal(), "opened");
  ASSERT_TRUE(tick_until([&] { return reading_.fresh; }));
  EXPECT_TRUE(pose_.has_orientation);
  // A turn about the service's z is one about our y.
  EXPECT_TRUE(pose_.orientation.isApprox(Eigen::Quaterniond(0.8, 0, 0.6, 0), 1e-9));
  EXPECT_EQ(reading_.buttons, 2u);
  service_->play([&](PlayedService& s) { s.grips = R"(,"wireless_verse_grip":[)" + grip + "," + grip + "]"; });
  EXPECT_TRUE(tick_until([&] { return reading_.fresh && !pose_.has_orientation && reading_.buttons == 0; }));
}

TEST_F(Inverse3, pushes_where_it_is_told_to) {
  service_->play([](PlayedService& s) { s.metres_per_newton = 0.01; });
  ASSERT_EQ(refusal(), "opened");
  const Eigen::Vector3d rest(10, 30, -20);
  for (const Eigen::Vector3d& force :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(-0.5, 1, -2)}) {
    newton_ = force;
    EXPECT_TRUE(tick_until([&] { return (pose_.position_mm - rest - 10 * force).norm() < 1e-6; })) << pose_.position_mm.transpose();
  }
  EXPECT_TRUE(service_->seen().newton.isApprox(Eigen::Vector3d(-0.5, 2, 1)));
  newton_.setZero();
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.isZero(0); }));
}

TEST_F(Inverse3, speaks_to_services_before_3_5) {
  service_->play([](PlayedService& s) { s.since_3_5 = false; });
  ASSERT_EQ(refusal(), "opened");
  newton_ = {0.25, 0, 0};
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.x() == 0.25; }));
  EXPECT_EQ(service_->seen().last_text,
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":{"x":0.25,"y":0,"z":0}}}}]})");
}

TEST_F(Inverse3, never_gets_more_than_the_device_holds) {
  options_.force_scale = 0.5;
  ASSERT_EQ(refusal(), "opened");
  newton_ = {30, 40, 0};
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.norm() > 3.99; }));
  newton_ = {1, 0, 0};
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.isApprox(Eigen::Vector3d(2, 0, 0)); }));
  newton_ = {1, std::nan(""), 0};
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.isZero(0); }));
  EXPECT_LE(service_->seen().longest_newton, kInverse3Figures.max_newton);
}

TEST_F(Inverse3, ends_a_force_when_the_loop_is_silent) {
  ASSERT_EQ(refusal(), "opened");
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
  // The last word is short.
  const std::int64_t now = clock_.now_ns();
  sends_ = false;
  pen_->send(now, {newton_, now + 3 * kMs});
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.isZero(0); }));
}

TEST_F(Inverse3, ends_a_force_when_the_service_is_silent) {
  ASSERT_EQ(refusal(), "opened");
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
  service_->play([](PlayedService& s) { s.answers = false; });
  valid_ns_ = 3 * kMs;
  const std::uint64_t before = service_->seen().messages;
  // Its loop goes on with its force, which a safety wouldn't do.
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.isZero(0); }));
  int poses = 0;
  int ticks = 0;
  tick_until([&] { return poses += reading_.fresh ? 1 : 0, ++ticks == 60; });
  EXPECT_TRUE(service_->seen().newton.isZero(0));
  EXPECT_LE(poses, 1);
  EXPECT_LE(service_->seen().messages, before + kMaxAsked + 2);
}

TEST_F(Inverse3, asks_a_slow_service_no_faster_than_it_answers) {
  service_->play([](PlayedService& s) { s.answer_delay_ms = 8; });
  ASSERT_EQ(refusal(), "opened");
  int poses = 0;
  ASSERT_TRUE(tick_until([&] { return poses += static_cast<int>(reading_.replies), poses >= 20; }));
  EXPECT_GE(pen_->round_trip_ns(), 8 * kMs);
  EXPECT_LE(service_->seen().messages, static_cast<std::uint64_t>(poses) + kMaxAsked + 1);
}

TEST_F(Inverse3, is_let_go_with_a_zero) {
  ASSERT_EQ(refusal(), "opened");
  newton_ = {0, 2, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.z() == 2; }));
  pen_.reset();
  link_.reset();
  for (int i = 0; i < 20'000 && !service_->seen().newton.isZero(0); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(service_->seen().newton.isZero(0));
}

TEST_F(Inverse3, is_gone_with_its_service_and_comes_back) {
  ASSERT_EQ(refusal(), "opened");
  ASSERT_TRUE(tick_until([&] { return reading_.fresh; }));
  const std::uint16_t port = service_->port();
  service_.reset();
  EXPECT_TRUE(tick_until([&] { return pen_->gone(); }));
  ASSERT_TRUE(tick_until([&] { return reading_.phase == PenPhase::absent; }));
  EXPECT_EQ(reading_.trouble, PenTrouble::io_error);
  const Result<std::unique_ptr<ServiceLink>> refused = ServiceLink::open(port, {}, 0);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), HasSubstr("start the Haply Inverse Service"));
  service_.emplace(port);
  ASSERT_TRUE(opens_again());
  EXPECT_TRUE(tick_until([&] { return reading_.fresh && reading_.phase == PenPhase::ready; }));
}

TEST_F(Inverse3, is_gone_when_it_is_unplugged_and_comes_back) {
  ASSERT_EQ(refusal(), "opened");
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
  service_->play([](PlayedService& s) { s.devices.clear(); });
  EXPECT_TRUE(tick_until([&] { return pen_->gone(); }));
  EXPECT_EQ(link_->end(), LinkEnd::unplugged);
  EXPECT_THAT(refusal(), HasSubstr("knows no Inverse3"));
  service_->play([](PlayedService& s) { s.devices = {"049D"}; });
  ASSERT_TRUE(opens_again());
  newton_.setZero();
  EXPECT_TRUE(tick_until([&] { return reading_.phase == PenPhase::ready; }));
}

TEST_F(Inverse3, gets_no_force_before_it_is_ready) {
  service_->play([](PlayedService& s) { s.ready = false; });
  ASSERT_EQ(refusal(), "opened");
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return reading_.replies > 0; }));
  EXPECT_EQ(reading_.phase, PenPhase::setting_up);
  EXPECT_FALSE(reading_.fresh);
  EXPECT_THAT(pen_->advice(), HasSubstr("isn't ready"));
  EXPECT_EQ(service_->seen().longest_newton, 0);
  service_->play([](PlayedService& s) { s.ready = true; });
  EXPECT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
}

TEST_F(Inverse3, stays_closed_with_a_sentence) {
  service_->play([](PlayedService& s) { s.devices = {"049D", "04BA"}; });
  EXPECT_THAT(refusal(), HasSubstr("2 Inverse3 are plugged in"));
  service_->play([](PlayedService& s) { s.devices = {"049D"}, s.in_use = true; });
  EXPECT_THAT(refusal(), HasSubstr("another program uses the Inverse3"));
  service_->play([](PlayedService& s) { s.in_use = false, s.basis = "XZY"; });
  EXPECT_THAT(refusal(), HasSubstr("set them back"));
  service_->play([](PlayedService& s) { s.greeting_instead = R"({"type":"welcome","inverse3":"none"})"; });
  EXPECT_THAT(refusal(), HasSubstr("doesn't talk like a Haply Inverse Service: \"inverse3\" isn't a list of devices"));
  EXPECT_EQ(service_->seen().messages, 0u);
}

TEST_F(Inverse3, ends_when_an_answer_cant_be_read) {
  ASSERT_EQ(refusal(), "opened");
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
  service_->play([](PlayedService& s) { s.instead = "{\"inverse3\":["; });
  EXPECT_TRUE(tick_until([&] { return reading_.trouble == PenTrouble::bad_reply; }));
  EXPECT_TRUE(pen_->gone());
  // With a zero behind the force.
  for (int i = 0; i < 20'000 && !service_->seen().newton.isZero(0); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(service_->seen().newton.isZero(0));
}

TEST_F(Inverse3, writes_nothing_while_the_guard_has_the_line) {
  std::atomic<bool> guarded = false;
  ASSERT_TRUE(open({[&] { return !guarded; }, [] {}}));
  newton_ = {1, 0, 0};
  ASSERT_TRUE(tick_until([&] { return service_->seen().newton.x() == 1; }));
  // A guard has a duplicate of the descriptor, and these bytes.
  guarded = true;
  ASSERT_EQ(::send(link_->descriptor(), link_->zero_frame().data(), link_->zero_frame().size(), 0),
            static_cast<ssize_t>(link_->zero_frame().size()));
  EXPECT_TRUE(tick_until([&] { return pen_->gone(); }));
  EXPECT_EQ(link_->end(), LinkEnd::guarded);
  for (int i = 0; i < 20'000 && !service_->seen().newton.isZero(0); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(service_->seen().newton.isZero(0));
  EXPECT_TRUE(service_->seen().well_formed);
}

TEST(Inverse3Links, say_what_listens_instead_of_the_service) {
  namespace asio = boost::asio;
  asio::io_context io;
  asio::ip::tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
  const std::uint16_t port = acceptor.local_endpoint().port();
  const Result<std::unique_ptr<ServiceLink>> mute = ServiceLink::open(port, {}, 0);
  ASSERT_FALSE(mute);
  EXPECT_THAT(mute.error().text(), HasSubstr("doesn't answer"));
  std::atomic<bool> ends = false;
  std::thread other([&] {
    boost::system::error_code ignored;
    std::vector<asio::ip::tcp::socket> taken;
    while (!ends) {
      taken.push_back(acceptor.accept());
      asio::write(taken.back(), asio::buffer(std::string("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")), ignored);
    }
  });
  std::string sentence = "doesn't answer";
  for (int attempt = 0; attempt < 50 && sentence.find("doesn't answer") != std::string::npos; ++attempt) {
    const Result<std::unique_ptr<ServiceLink>> page = ServiceLink::open(port, {}, 0);
    sentence = page ? "opened" : page.error().text();
  }
  ends = true;
  boost::system::error_code ignored;
  asio::ip::tcp::socket last(io);
  last.connect(acceptor.local_endpoint(), ignored);
  other.join();
  EXPECT_THAT(sentence, HasSubstr("isn't a Haply Inverse Service"));
}

/// Answers each force at once.
class PromptLink final : public ServiceLink {
 public:
  bool put(const LinkForce& force) override {
    answer_.asked_ns = force.asked_ns;
    answer_.answered_ns = force.asked_ns + 400'000;
    answer_.ready = answer_.has_position = waits_ = true;
    ++put_;
    return true;
  }
  std::optional<LinkAnswer> take() override { return std::exchange(waits_, false) ? std::optional(answer_) : std::nullopt; }
  std::uint64_t handled() const override { return handles ? put_ : 0; }
  LinkEnd end() const override { return LinkEnd::none; }
  int descriptor() const override { return -1; }
  const std::vector<std::byte>& zero_frame() const override { return zero_; }
  bool handles = true;

 private:
  LinkAnswer answer_;
  bool waits_ = false;
  std::uint64_t put_ = 0;
  std::vector<std::byte> zero_;
};

TEST(Inverse3Ticks, allocate_nothing) {
  PromptLink link;
  Inverse3Pen pen(link, {});
  const std::uint64_t before = port::allocations_of_this_thread();
  std::uint32_t fresh = 0;
  for (std::int64_t tick = 1; tick < 2000; ++tick) {
    fresh += pen.read(tick * kMs).fresh ? 1 : 0;
    pen.send(tick * kMs, {{0.5, 0.1, -1}, (tick + 3) * kMs});
    (void)pen.is_stuck(tick * kMs);
  }
  EXPECT_EQ(port::allocations_of_this_thread(), before);
  EXPECT_GT(fresh, 1990u);
}

TEST(Inverse3Ticks, see_a_thread_that_handles_nothing) {
  PromptLink link;
  Inverse3Pen pen(link, {});
  std::int64_t tick = 0;
  const auto stuck_after = [&](int ticks) {
    bool stuck = false;
    for (int i = 0; i < ticks; ++i) {
      ++tick;
      pen.send(tick * kMs, {{}, (tick + 3) * kMs});
      stuck = pen.is_stuck(tick * kMs);
    }
    return stuck;
  };
  EXPECT_FALSE(stuck_after(50));
  link.handles = false;
  EXPECT_FALSE(stuck_after(9));
  EXPECT_TRUE(stuck_after(4));
  link.handles = true;
  EXPECT_FALSE(stuck_after(1));
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::inverse3
