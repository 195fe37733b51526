#include "drivers/eye_tracker/dynasight/record.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr double kMax = std::numeric_limits<std::int16_t>::max();

std::int16_t big_endian(std::byte high, std::byte low) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(std::to_integer<unsigned>(high) << 8 | std::to_integer<unsigned>(low)));
}

int exponent_for(double max_units) {
  int exponent = 0;
  while (exponent < kMaxExponent && std::round(max_units / (1 << exponent)) > kMax) ++exponent;
  return exponent;
}

}  // namespace

std::optional<Record> decode(std::span<const std::byte, kRecordBytes> bytes) {
  if (!is_marker(bytes[0]) || !is_marker(bytes[1])) return std::nullopt;
  const auto first = std::to_integer<unsigned>(bytes[0]), second = std::to_integer<unsigned>(bytes[1]);
  Record record;
  record.status = static_cast<Status>(second & 3u);
  record.target = static_cast<int>((second & 4u) | (first >> 2 & 3u));
  record.exponent = static_cast<int>(first & 3u);
  for (std::size_t axis = 0; axis < 3; ++axis) record.numbers[axis] = big_endian(bytes[2 + 2 * axis], bytes[3 + 2 * axis]);
  return record;
}

RecordBytes encode(const Record& record) {
  const auto target = static_cast<unsigned>(record.target);
  RecordBytes bytes{};
  bytes[0] = static_cast<std::byte>(0x80u | (target & 3u) << 2 | (static_cast<unsigned>(record.exponent) & 3u));
  bytes[1] = static_cast<std::byte>(0x80u | (target & 4u) | static_cast<unsigned>(record.status));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<std::uint16_t>(record.numbers[axis]);
    bytes[2 + 2 * axis] = static_cast<std::byte>(number >> 8);
    bytes[3 + 2 * axis] = static_cast<std::byte>(number & 0xFFu);
  }
  return bytes;
}

Record record_for(const Eigen::Vector3d& position_mm, Status status, int target) {
  const Eigen::Vector3d units = position_mm / kUnitMm;
  Record record{.status = status, .target = target, .exponent = exponent_for(units.cwiseAbs().maxCoeff()), .numbers = {}};
  for (int axis = 0; axis < 3; ++axis) {
    const double number = std::round(units[axis] / (1 << record.exponent));
    record.numbers[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(std::clamp(number, -kMax, kMax));
  }
  return record;
}

}  // namespace prismesh::drivers::eye_tracker::dynasight
