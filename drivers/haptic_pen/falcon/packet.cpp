#include "drivers/haptic_pen/falcon/packet.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr std::byte kBegin{'<'}, kEnd{'>'};
constexpr unsigned kZero = 0x41;
constexpr std::size_t kFlags = 13, kUnknown = 14;
constexpr unsigned kHomingBit = 1, kButtonBits = 0x0F;

PacketBytes packet_of(const std::array<std::int16_t, 3>& numbers, unsigned flags) {
  PacketBytes bytes{};
  bytes.front() = kBegin;
  std::size_t at = 1;
  for (const std::int16_t number : numbers)
    for (unsigned nibble = 0; nibble < 4; ++nibble)
      bytes[at++] = static_cast<std::byte>(kZero + (static_cast<std::uint16_t>(number) >> (4 * nibble) & 0xFu));
  bytes[kFlags] = static_cast<std::byte>(kZero + flags);
  bytes[kUnknown] = static_cast<std::byte>(kZero);
  bytes.back() = kEnd;
  return bytes;
}

/// The numbers and flags; nothing if a byte is out of range.
std::optional<unsigned> read_packet(std::span<const std::byte, kPacketBytes> bytes, std::array<std::int16_t, 3>& numbers,
                                    unsigned max_flags) {
  if (bytes.front() != kBegin || bytes.back() != kEnd) return std::nullopt;
  for (std::size_t which = 0; which < numbers.size(); ++which) {
    unsigned value = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      const unsigned digit = std::to_integer<unsigned>(bytes[1 + 4 * which + nibble]) - kZero;  // wraps below the range
      if (digit > 0xF) return std::nullopt;
      value |= digit << (4 * nibble);
    }
    numbers[which] = static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
  }
  const unsigned flags = std::to_integer<unsigned>(bytes[kFlags]) - kZero;
  if (flags > max_flags || bytes[kUnknown] == kBegin || bytes[kUnknown] == kEnd) return std::nullopt;
  return flags;
}

}  // namespace

PacketBytes encode(const ForcePacket& packet) {
  return packet_of(packet.motors, static_cast<unsigned>((packet.lights & 7) << 1) | (packet.homing ? kHomingBit : 0u));
}

PacketBytes encode(const PosePacket& packet) {
  return packet_of(packet.encoders, static_cast<unsigned>((packet.homed & kAllHomed) << 4) | (packet.buttons & kButtonBits));
}

std::optional<ForcePacket> decode_force(std::span<const std::byte, kPacketBytes> bytes) {
  ForcePacket packet;
  const auto flags = read_packet(bytes, packet.motors, 0x0F);
  if (!flags) return std::nullopt;
  packet.lights = static_cast<std::uint8_t>(*flags >> 1);
  packet.homing = (*flags & kHomingBit) != 0;
  return packet;
}

std::optional<PosePacket> decode_pose(std::span<const std::byte, kPacketBytes> bytes) {
  PosePacket packet;
  const auto flags = read_packet(bytes, packet.encoders, 0x7F);
  if (!flags) return std::nullopt;
  packet.buttons = static_cast<std::uint8_t>(*flags & kButtonBits);
  packet.homed = static_cast<std::uint8_t>(*flags >> 4);
  return packet;
}

std::optional<PacketBytes> PacketFinder::take(std::byte byte) {
  if (byte == kBegin) {
    skipped_ += count_;
    count_ = 0;
  } else if (count_ == 0) {
    ++skipped_;
    return std::nullopt;
  }
  bytes_[count_++] = byte;
  if (count_ < kPacketBytes) {
    if (byte != kEnd) return std::nullopt;
  } else if (byte == kEnd) {
    count_ = 0;
    return bytes_;
  }
  skipped_ += count_;  // an end that comes too early or too late
  count_ = 0;
  return std::nullopt;
}

}  // namespace prismesh::drivers::haptic_pen::falcon
