#include "drivers/eye_tracker/opentrack/datagram.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace prismesh::drivers::eye_tracker::opentrack {
namespace {

constexpr double kMmPerCm = 10;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kFullTurnDegrees = 360;
constexpr std::size_t kNumbers = kDatagramBytes / sizeof(double);

double little_endian(std::span<const std::byte> bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(double); ++i) bits |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  return std::bit_cast<double>(bits);
}

}  // namespace

std::optional<Pose> decode(std::span<const std::byte> datagram) {
  if (datagram.size() != kDatagramBytes) return std::nullopt;
  std::array<double, kNumbers> numbers{};
  for (std::size_t i = 0; i < kNumbers; ++i) {
    numbers[i] = little_endian(datagram.subspan(i * sizeof(double), sizeof(double)));
    if (!std::isfinite(numbers[i])) return std::nullopt;
    if (i >= 3 && std::abs(numbers[i]) > kFullTurnDegrees) return std::nullopt;
  }
  return Pose{{numbers[0], numbers[1], numbers[2]}, numbers[3], numbers[4], numbers[5]};
}

std::array<std::byte, kDatagramBytes> encode(const Pose& pose) {
  const std::array<double, kNumbers> numbers{pose.position_cm.x(), pose.position_cm.y(), pose.position_cm.z(),
                                             pose.yaw_degrees,     pose.pitch_degrees,   pose.roll_degrees};
  std::array<std::byte, kDatagramBytes> bytes{};
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(numbers[i]);
    for (std::size_t k = 0; k < sizeof(double); ++k) bytes[i * sizeof(double) + k] = static_cast<std::byte>(bits >> (8 * k) & 0xFFu);
  }
  return bytes;
}

Eigen::Vector3d screen_position_mm(const Pose& pose) {
  return {-kMmPerCm * pose.position_cm.x(), kMmPerCm * pose.position_cm.y(), kMmPerCm * pose.position_cm.z()};
}

// The direction to the right ear of a head that faces the screen, after roll, then pitch, then yaw.
Eigen::Vector3d toward_right(const Pose& pose) {
  const double yaw = pose.yaw_degrees * kRadiansPerDegree;
  const double pitch = pose.pitch_degrees * kRadiansPerDegree;
  const double roll = pose.roll_degrees * kRadiansPerDegree;
  const double forward = -std::sin(pitch) * std::sin(roll), aside = std::cos(roll);  // before the yaw
  return {forward * std::sin(yaw) + aside * std::cos(yaw), std::cos(pitch) * std::sin(roll),
          aside * std::sin(yaw) - forward * std::cos(yaw)};
}

Pose pose_for(const Eigen::Vector3d& position_mm, const Eigen::Vector3d& toward_right) {
  Pose pose;
  pose.position_cm = {-position_mm.x() / kMmPerCm, position_mm.y() / kMmPerCm, position_mm.z() / kMmPerCm};
  pose.yaw_degrees = std::atan2(toward_right.z(), toward_right.x()) / kRadiansPerDegree;
  pose.roll_degrees = std::asin(std::clamp(toward_right.y(), -1.0, 1.0)) / kRadiansPerDegree;
  return pose;
}

}  // namespace prismesh::drivers::eye_tracker::opentrack
