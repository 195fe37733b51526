#include "drivers/haptic_pen/hand_script.h"

#include <string>

#include <gtest/gtest.h>

#include "drivers/haptic_pen/framed/framed_pen.h"
#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/port/memory_line.h"

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr const char* kScript =
    "# a push\n"
    "0 0 0 40  0 0 holds\n"
    "\n"
    "2 10 0 -10  1 0 holds  # with the button\r\n"
    "3\t10 0 20  2 0.5 free";

TEST(HandScript, goes_straight_from_place_to_place) {
  const HandScript script = HandScript::parse(kScript, "push.hand").value();
  EXPECT_EQ(script.seconds(), 3);
  EXPECT_EQ(script.at(-1).goal_mm, Eigen::Vector3d(0, 0, 40));
  EXPECT_TRUE(script.at(1).goal_mm.isApprox(Eigen::Vector3d(5, 0, 15)));
  EXPECT_EQ(script.at(1).buttons, 0u);
  EXPECT_EQ(script.at(2).buttons, 1u);
  EXPECT_TRUE(script.at(2.5).goal_mm.isApprox(Eigen::Vector3d(10, 0, 5)));
  EXPECT_GT(script.at(2.5).stiffness_newton_m, 0);
}

TEST(HandScript, stays_and_trembles_after_its_last_line) {
  const HandScript script = HandScript::parse(kScript, "push.hand").value();
  double farthest = 0;
  for (double s = 3; s < 5; s += 0.01) {
    const SimulatedHand hand = script.at(s);
    EXPECT_EQ(hand.buttons, 2u);
    EXPECT_EQ(hand.stiffness_newton_m, 0) << "it lets go";
    farthest = std::max(farthest, (hand.goal_mm - Eigen::Vector3d(10, 0, 20)).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(farthest, 0.45);
  EXPECT_LE(farthest, 0.5);
}

TEST(HandScript, says_which_line_is_wrong) {
  const auto refusal = [](const std::string& text) {
    const auto parsed = HandScript::parse(text, "push.hand");
    return parsed ? "" : parsed.error().text();
  };
  EXPECT_EQ(refusal(""), "push.hand: it says nothing of what the hand does");
  EXPECT_EQ(refusal("# nothing\n\n"), "push.hand: it says nothing of what the hand does");
  EXPECT_EQ(refusal("0 0 0 0 0 0 holds\n0 0 0\n"), "push.hand:2: expected seconds, then x y z from -60 to 60 mm");
  EXPECT_EQ(refusal("0 0 0 61 0 0 holds\n"), "push.hand:1: expected seconds, then x y z from -60 to 60 mm");
  EXPECT_EQ(refusal("0 0 nan 0 0 0 holds\n"), "push.hand:1: expected seconds, then x y z from -60 to 60 mm");
  EXPECT_EQ(refusal("0 0 0 0 4 0 holds\n"), "push.hand:1: expected the buttons behind the place: 0 to 3");
  EXPECT_EQ(refusal("0 0 0 0 0 9 holds\n"), "push.hand:1: expected how far the hand trembles behind the buttons: 0 to 5 mm");
  EXPECT_EQ(refusal("0 0 0 0 0 0 grips\n"), "push.hand:1: expected \"holds\" or \"free\" at the end");
  EXPECT_EQ(refusal("0 0 0 0 0 0 holds 3\n"), "push.hand:1: expected \"holds\" or \"free\" at the end");
  EXPECT_EQ(refusal("1 0 0 0 0 0 holds\n1 0 0 0 0 0 holds\n"), "push.hand:2: the time must be later than that of the line before");
}

TEST(HandScript, reaches_the_host_with_its_buttons) {
  const HandScript script = HandScript::parse("0 0 0 0 0 0 holds\n0.2 20 0 0 1 0 holds\n0.4 20 0 0 2 0 holds\n", "slide.hand").value();
  ManualClock clock;
  port::MemoryLine line(clock, {.host_baud = 4'000'000, .device_baud = 4'000'000});
  const auto host = line.open_host().value();
  framed::SimulatedDevice device(line.device(), {}, [&](double s) { return script.at(s); });
  framed::FramedPen pen(*host, framed::simulated_limits({}));
  clock.advance_ns(1'000'000'000);
  PenReading reading;
  double reached = 0;
  std::uint32_t at_300_ms = 0;
  for (int ms = 0; ms < 800; ++ms) {
    clock.advance_ns(1'000'000);
    device.step(clock.now_ns());
    clock.advance_ns(200'000);
    reading = pen.read(clock.now_ns());
    if (reading.fresh) reached = reading.pose.position_mm.x();
    if (ms == 300) at_300_ms = reading.buttons;
  }
  EXPECT_NEAR(reached, 20, 0.5);
  EXPECT_EQ(at_300_ms, 1u);
  EXPECT_EQ(reading.buttons, 2u);
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen
