#include "drivers/eye_tracker/opentrack/datagram.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh::drivers::eye_tracker::opentrack {
namespace {

TEST(OpentrackDatagram, six_little_endian_doubles_in_order) {
  // 1.0, -2.0, 65.5, 10.0, -5.0, 0.5 as IEEE 754, low byte first.
  constexpr std::uint64_t kBits[] = {0x3FF0000000000000, 0xC000000000000000, 0x4050600000000000,
                                     0x4024000000000000, 0xC014000000000000, 0x3FE0000000000000};
  std::array<std::byte, kDatagramBytes> bytes{};
  for (std::size_t i = 0; i < kDatagramBytes; ++i) bytes[i] = static_cast<std::byte>(kBits[i / 8] >> (8 * (i % 8)) & 0xFF);
  const auto pose = decode(bytes);
  ASSERT_TRUE(pose);
  EXPECT_EQ(*pose, (Pose{{1, -2, 65.5}, 10, -5, 0.5}));
  EXPECT_EQ(encode(*pose), bytes);
}

TEST(OpentrackDatagram, refuses_another_length) {
  const auto bytes = encode({});
  std::vector<std::byte> longer(bytes.begin(), bytes.end());
  longer.push_back({});
  EXPECT_FALSE(decode({}));
  EXPECT_FALSE(decode(std::span(bytes).first(47)));
  EXPECT_FALSE(decode(longer));
}

TEST(OpentrackDatagram, refuses_numbers_that_arent_finite_and_impossible_angles) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()})
    for (int where = 0; where < 6; ++where) {
      auto bytes = encode({{1, 2, 60}, 3, 4, 5});
      std::memcpy(bytes.data() + 8 * where, &bad, 8);
      EXPECT_FALSE(decode(bytes)) << where;
    }
  EXPECT_FALSE(decode(encode({{0, 0, 60}, 361, 0, 0})));
  EXPECT_FALSE(decode(encode({{0, 0, 60}, 0, 0, -1e300})));
}

TEST(OpentrackDatagram, x_points_to_the_viewers_left_y_up_and_z_away_from_the_screen) {
  EXPECT_TRUE(screen_position_mm({{-12, 3, 65}, 0, 0, 0}).isApprox(Eigen::Vector3d(120, 30, 650)));
}

struct Turn {
  double yaw, pitch, roll;
  Eigen::Vector3d right;
};

TEST(OpentrackDatagram, the_eyes_follow_yaw_pitch_and_roll) {
  const double half = std::sqrt(0.5);
  const Turn turns[] = {
      {0, 0, 0, {1, 0, 0}},          {45, 0, 0, {half, 0, half}},  // turned to its right: the right eye moves back
      {-45, 0, 0, {half, 0, -half}}, {0, 30, 0, {1, 0, 0}},        // nodding leaves the eyes level
      {0, 0, 45, {half, half, 0}},                                 // leaning to its left: the right eye moves up
      {90, 0, 45, {0, half, half}},                                // turned, then leaned
      {0, 90, 90, {0, 0, 1}},                                      // looks up; leaned to its left, the right eye is in front
  };
  for (const Turn& turn : turns) {
    const Eigen::Vector3d right = toward_right({{0, 0, 60}, turn.yaw, turn.pitch, turn.roll});
    EXPECT_LE((right - turn.right).norm(), 1e-12) << turn.yaw << " " << turn.pitch << " " << turn.roll << ": " << right.transpose();
  }
}

TEST(OpentrackDatagram, the_direction_of_the_eyes_is_a_unit_vector_at_all_angles) {
  for (int yaw = -180; yaw <= 180; yaw += 15)
    for (int pitch = -90; pitch <= 90; pitch += 15)
      for (int roll = -180; roll <= 180; roll += 15) {
        const Pose pose{{0, 0, 60}, static_cast<double>(yaw), static_cast<double>(pitch), static_cast<double>(roll)};
        EXPECT_NEAR(toward_right(pose).norm(), 1, 1e-12);
      }
}

TEST(OpentrackDatagram, a_pose_has_the_position_and_direction_it_was_made_for) {
  for (double yaw = -60; yaw <= 60; yaw += 20)
    for (double roll = -50; roll <= 50; roll += 20) {
      const Eigen::Vector3d place(120, -30, 700);
      const Eigen::Vector3d right = toward_right({{0, 0, 60}, yaw, 0, roll});
      const auto pose = decode(encode(pose_for(place, right)));
      ASSERT_TRUE(pose);
      EXPECT_TRUE(screen_position_mm(*pose).isApprox(place, 1e-12));
      EXPECT_LE((toward_right(*pose) - right).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::opentrack
