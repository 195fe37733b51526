#include "drivers/haptic_pen/falcon/packet.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

std::string falcon_text(const PacketBytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
PacketBytes falcon_bytes(std::string_view text) {
  PacketBytes bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
  return bytes;
}

TEST(FalconPackets, are_these_bytes) {
  EXPECT_EQ(falcon_text(encode(ForcePacket{.lights = 0, .homing = false})), "<AAAAAAAAAAAAAA>");
  EXPECT_EQ(falcon_text(encode(ForcePacket{.motors = {1, -1, 0x1234}, .lights = kGreen, .homing = true})), "<BAAAPPPPEDCBFA>");
  EXPECT_EQ(falcon_text(encode(PosePacket{.encoders = {1, -1, 0x1234}, .buttons = 5, .homed = 3})), "<BAAAPPPPEDCBvA>");
}

TEST(FalconPackets, agree_with_the_example_in_libnifalcons_documentation) {
  // 0xFA59 arrives as 9 5 A F. The text there negates it afterwards, which its code doesn't.
  const auto pose = decode_pose(falcon_bytes("<JFKPAAAAAAAAAA>"));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->encoders[0], -1447);
}

TEST(FalconPackets, come_back_as_they_were) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    ForcePacket force;
    PosePacket pose;
    for (std::size_t k = 0; k < 3; ++k) {
      force.motors[k] = static_cast<std::int16_t>(random());
      pose.encoders[k] = static_cast<std::int16_t>(random());
    }
    force.lights = random() & 7;
    force.homing = (random() & 1) != 0;
    pose.buttons = random() & 15;
    pose.homed = random() & 7;
    const auto force_again = decode_force(encode(force));
    const auto pose_again = decode_pose(encode(pose));
    ASSERT_TRUE(force_again && pose_again);
    EXPECT_EQ(force_again->motors, force.motors);
    EXPECT_EQ(force_again->lights, force.lights);
    EXPECT_EQ(force_again->homing, force.homing);
    EXPECT_EQ(pose_again->encoders, pose.encoders);
    EXPECT_EQ(pose_again->buttons, pose.buttons);
    EXPECT_EQ(pose_again->homed, pose.homed);
  }
}

TEST(FalconPackets, with_a_byte_out_of_range_are_refused) {
  const PacketBytes good = encode(PosePacket{.encoders = {100, -100, 7}});
  for (std::size_t at = 0; at < kPacketBytes; ++at)
    for (const int wrong : {0x00, 0x40, 0xC5, 0xFF}) {
      PacketBytes bytes = good;
      bytes[at] = static_cast<std::byte>(wrong);
      EXPECT_EQ(decode_pose(bytes).has_value(), at == 14) << at << " " << wrong;
    }
}

TEST(FalconPackets, are_found_however_they_are_cut) {
  const std::string two = falcon_text(encode(PosePacket{.encoders = {1, 2, 3}})) + falcon_text(encode(PosePacket{.encoders = {4, 5, 6}}));
  // A packet cut short at each length, then two whole ones.
  for (std::size_t length = 0; length < kPacketBytes; ++length) {
    PacketFinder finder;
    std::vector<PosePacket> found;
    for (const char each : two.substr(0, length) + two)
      if (const auto bytes = finder.take(static_cast<std::byte>(each))) found.push_back(*decode_pose(*bytes));
    ASSERT_EQ(found.size(), 2u) << length;
    EXPECT_EQ(found[1].encoders[2], 6);
    EXPECT_EQ(finder.skipped(), length);
  }
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::falcon
