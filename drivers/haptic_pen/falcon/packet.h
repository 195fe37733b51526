// The packets between a host and a Falcon that runs its maker's firmware: motor forces one way, joint angles the other. 16 printable bytes
// each, as libnifalcon describes them (FalconFirmwareNovintSDK.h): `<`, three numbers of four nibbles, lights or buttons, one byte without
// a known meaning, `>`. Each nibble is sent as 0x41 + nibble, the lowest first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace prismesh::drivers::haptic_pen::falcon {

inline constexpr std::size_t kPacketBytes = 16;
using PacketBytes = std::array<std::byte, kPacketBytes>;

/// Bits of the lights.
inline constexpr std::uint8_t kRed = 1, kGreen = 2, kBlue = 4;

/// From the host; the device answers each with a pose packet. In the order of the arms: top, right, left, seen from the front.
struct ForcePacket {
  std::array<std::int16_t, 3> motors{};
  std::uint8_t lights = 0;
  bool homing = true;  ///< the device reports and uses its homing marks; belongs into every packet
};

struct PosePacket {
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t buttons = 0;  ///< a bit each: right, forward, centre, left
  std::uint8_t homed = 0;    ///< a bit each arm
};
inline constexpr std::uint8_t kAllHomed = 7;

PacketBytes encode(const ForcePacket& packet);
PacketBytes encode(const PosePacket& packet);
/// Nothing: not `<` and `>`, a byte out of range.
std::optional<ForcePacket> decode_force(std::span<const std::byte, kPacketBytes> bytes);
std::optional<PosePacket> decode_pose(std::span<const std::byte, kPacketBytes> bytes);

/// Finds packets in a stream of bytes, however they were cut. Allocates nothing. `<` and `>` stand nowhere else in a packet, so a packet
/// that was cut short costs no other.
class PacketFinder {
 public:
  /// Takes one byte; a packet that it completes. Bytes that belong to none are counted.
  std::optional<PacketBytes> take(std::byte byte);
  void clear() { count_ = 0; }
  std::uint64_t skipped() const { return skipped_; }

 private:
  PacketBytes bytes_{};
  std::size_t count_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen::falcon
