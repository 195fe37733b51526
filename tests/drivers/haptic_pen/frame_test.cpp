#include "drivers/haptic_pen/framed/frame.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

namespace prismesh::drivers::haptic_pen::framed {
namespace {

std::string hex(const FrameBytes& bytes) {
  std::string text;
  for (const std::byte each : bytes) {
    char two[3];
    std::snprintf(two, sizeof two, "%02X", std::to_integer<unsigned>(each));
    text += two;
  }
  return text;
}

TEST(PenFrames, are_these_bytes) {
  EXPECT_EQ(hex(encode(ForceFrame{.number = 7, .newton = {1.5, -0.25, 0.001}, .valid_ms = 3, .sender = Sender::guard})).substr(0, 40),
            "A55A4607DC0506FF0100030001"
            "00000000000000");
  EXPECT_EQ(
      hex(encode(PoseFrame{.number = 9, .position_mm = {1, -2, 0.5}, .phase = PenPhase::ready, .buttons = 2, .answers = 7})).substr(0, 40),
      "A55A5009E803000030F8FFFFF401000003020700");
}

TEST(PenFrames, come_back_as_they_were) {
  const ForceFrame force{.number = 255, .newton = {7.999, -3.25, 0}, .valid_ms = 3, .sender = Sender::loop};
  const auto force_back = decode_force(encode(force));
  ASSERT_TRUE(force_back);
  EXPECT_EQ(force_back->number, 255);
  EXPECT_TRUE(force_back->newton.isApprox(force.newton, 1e-12));
  EXPECT_EQ(force_back->valid_ms, 3);
  const PoseFrame pose{.number = 1, .position_mm = {-59.98, 12.34, 0.02}, .phase = PenPhase::homing, .buttons = 5, .answers = 200};
  const auto pose_back = decode_pose(encode(pose));
  ASSERT_TRUE(pose_back);
  EXPECT_TRUE(pose_back->position_mm.isApprox(pose.position_mm, 1e-12));
  EXPECT_EQ(pose_back->phase, PenPhase::homing);
  EXPECT_EQ(pose_back->answers, 200);
  EXPECT_FALSE(decode_pose(encode(force)));
  EXPECT_FALSE(decode_force(encode(pose)));
}

TEST(PenFrames, never_hold_a_longer_force) {
  for (const double newton : {0.0009, 1.9999, -1.9999, 32.9, -1e300}) {
    const auto back = decode_force(encode(ForceFrame{.newton = {newton, 0, 0}}));
    ASSERT_TRUE(back);
    EXPECT_LE(std::abs(back->newton.x()), std::abs(newton));
    EXPECT_LT(std::abs(back->newton.x()), 32.768);
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(decode_force(encode(ForceFrame{.newton = {1, kNan, 0}}))->newton.isZero(0));
  EXPECT_TRUE(decode_force(encode(ForceFrame{.newton = {kInfinite, 1, 0}}))->newton.isZero(0));
}

TEST(PenFrames, with_a_wrong_bit_are_refused) {
  const FrameBytes right = encode(PoseFrame{.number = 1, .position_mm = {1, 2, 3}, .phase = PenPhase::ready});
  for (std::size_t bit = 0; bit < 8 * kFrameBytes; ++bit) {
    FrameBytes wrong = right;
    wrong[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_FALSE(decode_pose(wrong)) << bit;
  }
}

TEST(PenFrames, are_found_between_other_bytes_and_in_pieces) {
  std::vector<std::byte> stream(7, std::byte{0xA5});
  for (std::uint8_t i = 0; i < 5; ++i) {
    const FrameBytes frame = encode(PoseFrame{.number = i, .phase = PenPhase::ready});
    stream.insert(stream.end(), frame.begin(), frame.end());
    if (i == 2) stream.insert(stream.end(), 3, std::byte{0x5A});
  }
  for (const std::size_t piece : {std::size_t{1}, std::size_t{5}, std::size_t{22}, stream.size()}) {
    FrameFinder finder;
    std::uint8_t found = 0;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      const std::size_t count = std::min(piece, stream.size() - at);
      std::memcpy(finder.space().data(), stream.data() + at, count);
      finder.received(count);
      while (const auto frame = finder.next()) EXPECT_EQ(decode_pose(*frame)->number, found++);
    }
    EXPECT_EQ(found, 5) << piece;
    EXPECT_EQ(finder.skipped(), 10U);
  }
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::framed
