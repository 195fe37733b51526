#include "drivers/haptic_pen/framed/frame.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptic_pen::framed {
namespace {

constexpr std::byte kStart0{0xA5}, kStart1{0x5A};
constexpr std::uint8_t kForce = 'F', kPose = 'P';
constexpr std::size_t kContent = 4, kCrc = kFrameBytes - 2;
constexpr double kMaxMicrometres = 2e6;

/// CRC-16/CCITT-FALSE: polynomial 0x1021, from 0xFFFF.
std::uint16_t crc(std::span<const std::byte> bytes) {
  unsigned value = 0xFFFF;
  for (const std::byte each : bytes) {
    value ^= std::to_integer<unsigned>(each) << 8;
    for (int bit = 0; bit < 8; ++bit) value = ((value << 1) ^ ((value & 0x8000) != 0 ? 0x1021u : 0u)) & 0xFFFF;
  }
  return static_cast<std::uint16_t>(value);
}

/// Little-endian.
void put(FrameBytes& bytes, std::size_t at, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
}
std::uint32_t get(std::span<const std::byte, kFrameBytes> bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

FrameBytes begin(std::uint8_t kind, std::uint8_t number) {
  FrameBytes bytes{};
  bytes[0] = kStart0;
  bytes[1] = kStart1;
  bytes[2] = static_cast<std::byte>(kind);
  bytes[3] = static_cast<std::byte>(number);
  return bytes;
}

std::span<const std::byte> checked_part(std::span<const std::byte, kFrameBytes> bytes) { return bytes.subspan(2, kCrc - 2); }

bool sound(std::span<const std::byte, kFrameBytes> bytes) {
  return bytes[0] == kStart0 && bytes[1] == kStart1 && get(bytes, kCrc, 2) == crc(checked_part(bytes));
}

FrameBytes finished(FrameBytes bytes) {
  put(bytes, kCrc, crc(checked_part(bytes)), 2);
  return bytes;
}

}  // namespace

FrameBytes encode(const ForceFrame& frame) {
  FrameBytes bytes = begin(kForce, frame.number);
  const bool finite = frame.newton.allFinite();
  for (int axis = 0; axis < 3; ++axis) {
    const double mn = finite ? std::clamp(std::trunc(frame.newton[axis] * 1e3), -32767.0, 32767.0) : 0;
    put(bytes, kContent + 2 * static_cast<std::size_t>(axis), static_cast<std::uint32_t>(static_cast<std::int32_t>(mn)), 2);
  }
  put(bytes, kContent + 6, frame.valid_ms, 2);
  put(bytes, kContent + 8, static_cast<std::uint32_t>(frame.sender), 1);
  return finished(bytes);
}

FrameBytes encode(const PoseFrame& frame) {
  FrameBytes bytes = begin(kPose, frame.number);
  for (int axis = 0; axis < 3; ++axis) {
    const double um = std::clamp(std::round(frame.position_mm[axis] * 1e3), -kMaxMicrometres, kMaxMicrometres);
    put(bytes, kContent + 4 * static_cast<std::size_t>(axis), static_cast<std::uint32_t>(static_cast<std::int32_t>(um)), 4);
  }
  put(bytes, kContent + 12, static_cast<std::uint32_t>(frame.phase), 1);
  put(bytes, kContent + 13, frame.buttons, 1);
  put(bytes, kContent + 14, frame.answers, 1);
  return finished(bytes);
}

std::optional<ForceFrame> decode_force(std::span<const std::byte, kFrameBytes> bytes) {
  if (!sound(bytes) || get(bytes, 2, 1) != kForce || get(bytes, kContent + 8, 1) > 1) return std::nullopt;
  ForceFrame frame;
  frame.number = static_cast<std::uint8_t>(get(bytes, 3, 1));
  for (int axis = 0; axis < 3; ++axis)
    frame.newton[axis] = static_cast<std::int16_t>(get(bytes, kContent + 2 * static_cast<std::size_t>(axis), 2)) * 1e-3;
  frame.valid_ms = static_cast<std::uint16_t>(get(bytes, kContent + 6, 2));
  frame.sender = static_cast<Sender>(get(bytes, kContent + 8, 1));
  return frame;
}

std::optional<PoseFrame> decode_pose(std::span<const std::byte, kFrameBytes> bytes) {
  if (!sound(bytes) || get(bytes, 2, 1) != kPose) return std::nullopt;
  if (get(bytes, kContent + 12, 1) > static_cast<std::uint32_t>(PenPhase::ready)) return std::nullopt;
  PoseFrame frame;
  frame.number = static_cast<std::uint8_t>(get(bytes, 3, 1));
  for (int axis = 0; axis < 3; ++axis) {
    const double um = static_cast<std::int32_t>(get(bytes, kContent + 4 * static_cast<std::size_t>(axis), 4));
    if (std::abs(um) > kMaxMicrometres) return std::nullopt;
    frame.position_mm[axis] = um * 1e-3;
  }
  frame.phase = static_cast<PenPhase>(get(bytes, kContent + 12, 1));
  frame.buttons = static_cast<std::uint8_t>(get(bytes, kContent + 13, 1));
  frame.answers = static_cast<std::uint8_t>(get(bytes, kContent + 14, 1));
  return frame;
}

std::optional<FrameBytes> FrameFinder::next() {
  while (end_ - begin_ >= kFrameBytes) {
    const auto here = std::span<const std::byte>(bytes_).subspan(begin_).first<kFrameBytes>();
    if (sound(here)) {
      FrameBytes found;
      std::copy(here.begin(), here.end(), found.begin());
      begin_ += kFrameBytes;
      return found;
    }
    ++begin_;
    ++skipped_;
  }
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
  end_ -= begin_;
  begin_ = 0;
  return std::nullopt;
}

}  // namespace prismesh::drivers::haptic_pen::framed
