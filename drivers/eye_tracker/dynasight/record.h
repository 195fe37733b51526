// Codec for the 8-byte position record of DynaSight trackers and of the D4D display's built-in tracker, bit by bit:
//
//   1000TTEE 1000?tSS Xhi Xlo Yhi Ylo Zhi Zlo
//
// EE: exponent; a coordinate is its 16-bit number shifted left by EE, in units of 0.05 mm. tTT: target, t the high bit. SS: status. `?` has
// no known meaning and is ignored. There is no checksum and no byte that only occurs as a header; dynasight/synchroniser.h finds the
// records. docs/devices/eye-tracker.md describes the protocol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker::dynasight {

inline constexpr std::size_t kRecordBytes = 8;
inline constexpr double kUnitMm = 0.05;
inline constexpr int kMaxExponent = 3;

enum class Status : std::uint8_t {
  search = 0,   ///< no target; the coordinates are meaningless
  coast = 1,    ///< the target was just lost; the coordinates are the device's extrapolation
  caution = 2,  ///< a target with a weak signal
  track = 3,
};

struct Record {
  Status status = Status::search;
  int target = 0;                         ///< 0..7
  int exponent = 0;                       ///< 0..3
  std::array<std::int16_t, 3> numbers{};  ///< x, y, z as sent, not yet shifted

  /// Returns a coordinate in units of 0.05 mm.
  std::int32_t units(std::size_t axis) const { return std::int32_t{numbers[axis]} * (std::int32_t{1} << exponent); }
  /// Returns the position in the device's coordinates: x right, y up, z toward the viewer.
  Eigen::Vector3d position_mm() const { return {units(0) * kUnitMm, units(1) * kUnitMm, units(2) * kUnitMm}; }
  bool sees_head() const { return status != Status::search; }
  bool operator==(const Record&) const = default;
};

using RecordBytes = std::array<std::byte, kRecordBytes>;

/// Returns whether a byte may be one of the first two of a record: 0x80..0x8F.
constexpr bool is_marker(std::byte byte) { return (byte & std::byte{0xF0}) == std::byte{0x80}; }

/// Returns nothing if one of the first two bytes isn't a marker.
std::optional<Record> decode(std::span<const std::byte, kRecordBytes> bytes);

RecordBytes encode(const Record& record);

/// Returns the record for a position, with the smallest exponent that can hold it, rounded to the nearest value of that exponent. Limits
/// coordinates to 13.1 m.
Record record_for(const Eigen::Vector3d& position_mm, Status status = Status::track, int target = 0);

}  // namespace prismesh::drivers::eye_tracker::dynasight
