// The frames between a host and a pen: forces one way, poses the other. docs/haptics.md describes their bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptic_pen::framed {

/// Two bytes of start, the kind, a number, 16 bytes of content, a CRC-16 of all that follows the start.
inline constexpr std::size_t kFrameBytes = 22;
using FrameBytes = std::array<std::byte, kFrameBytes>;

enum class Sender : std::uint8_t { loop, guard };

/// From the host. The device applies it until `valid_ms` have passed; then it applies zero by itself.
struct ForceFrame {
  std::uint8_t number = 0;
  Eigen::Vector3d newton = Eigen::Vector3d::Zero();  ///< in steps of 1 mN, at most 32.767 N in each direction
  std::uint16_t valid_ms = 0;
  Sender sender = Sender::loop;  ///< for logs of the line
};

/// From the device, once a millisecond.
struct PoseFrame {
  std::uint8_t number = 0;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< in steps of 1 um, at most 2 m
  PenPhase phase = PenPhase::setting_up;
  std::uint8_t buttons = 0;
  std::uint8_t answers = 0;  ///< number of the newest force frame that has arrived
};

/// Shortens each part of a force to whole millinewtons, so that no frame holds a longer force. A number that isn't finite becomes zero.
FrameBytes encode(const ForceFrame& frame);
FrameBytes encode(const PoseFrame& frame);
/// Nothing: another kind, a wrong start or CRC, a value out of range.
std::optional<ForceFrame> decode_force(std::span<const std::byte, kFrameBytes> bytes);
std::optional<PoseFrame> decode_pose(std::span<const std::byte, kFrameBytes> bytes);

/// Finds frames in a stream of bytes. Allocates nothing.
class FrameFinder {
 public:
  /// Where to put received bytes, and how many were put there. Call `next` until it returns nothing before the next `space`.
  std::span<std::byte> space() { return std::span(bytes_).subspan(end_); }
  void received(std::size_t count) { end_ += count; }
  /// The next whole frame with a right CRC; bytes that belong to none are passed over and counted.
  std::optional<FrameBytes> next();
  void clear() { begin_ = end_ = 0; }
  std::uint64_t skipped() const { return skipped_; }

 private:
  std::array<std::byte, 64 * kFrameBytes> bytes_{};
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen::framed
