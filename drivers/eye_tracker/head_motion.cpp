#include "drivers/eye_tracker/head_motion.h"

#include <array>
#include <cmath>
#include <string>

#include "base/deterministic_math.h"
#include "base/nearest_name.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Vector3d;

/// A point's position and velocity.
struct PointMotion {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
};

/// Returns a number uniform in 0..1 for a seed and purpose (the finaliser of SplitMix64).
double uniform(std::uint64_t seed, std::uint64_t purpose) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u + purpose * 0xd1b54a32d192ed03u + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// Purposes of `uniform`: steps count from 0, waves from these numbers.
constexpr std::uint64_t kTremorWaves = 1'000'000'000'000;
constexpr std::uint64_t kSlowWaves = 2'000'000'000'000;
constexpr std::uint64_t kSwayWaves = 3'000'000'000'000;
constexpr std::uint64_t kFirstDirection = 4'000'000'000'000;

/// A sum of sine waves in a frequency band.
struct Waves {
  std::uint64_t purpose;  ///< for `uniform`
  Vector3d rms_mm;        ///< root mean square of each axis
  double min_hz, max_hz;
};

/// Adds waves of seeded frequency and phase to all three axes.
void add_waves(PointMotion& motion, double seconds, std::uint64_t seed, const Waves& waves) {
  constexpr int kWaves = 3;
  std::uint64_t purpose = waves.purpose;
  for (int axis = 0; axis < 3; ++axis) {
    const double amplitude = waves.rms_mm[axis] * std::sqrt(2.0 / kWaves);
    for (int wave = 0; wave < kWaves; ++wave) {
      purpose += 2;
      // One wave in each third of the band, so that no seed has all of them at one end.
      const double hz = waves.min_hz + (waves.max_hz - waves.min_hz) * (wave + uniform(seed, purpose)) / kWaves;
      const double angular_frequency = 2 * kPi * hz;
      const double angle = angular_frequency * seconds + 2 * kPi * uniform(seed, purpose + 1);
      motion.position[axis] += amplitude * std::sin(angle);
      motion.velocity[axis] += amplitude * angular_frequency * std::cos(angle);
    }
  }
}

/// The minimum-jerk transition from 0 to 1, as in people's reaching and turning [Flash 1985]. At rest at both ends; its max.
/// slope is 1.875 / duration.
struct StepProfile {
  double share = 0;
  double share_per_second = 0;
};
StepProfile minimum_jerk(double seconds, double duration) {
  const double u = seconds / duration;
  if (u <= 0) return {};
  if (u >= 1) return {1, 0};
  return {u * u * u * (10 + u * (6 * u - 15)), 30 * u * u * (1 - u) * (1 - u) / duration};
}

/// Steps back and forth, one per time slot, each starting at a seeded time within its slot.
struct Steps {
  Vector3d there;  ///< from one end to the other
  double slot_s;
  double duration_s;
};
void add_steps(PointMotion& motion, double seconds, std::uint64_t seed, const Steps& steps) {
  const double slot = std::floor(seconds / steps.slot_s);
  const auto number = static_cast<std::int64_t>(slot);
  const double start = uniform(seed, static_cast<std::uint64_t>(number)) * (steps.slot_s - steps.duration_s);
  const StepProfile at = minimum_jerk(seconds - slot * steps.slot_s - start, steps.duration_s);
  const bool goes_there = (number % 2 == 0) == (uniform(seed, kFirstDirection) < 0.5);
  const double sign = goes_there ? 1 : -1;
  motion.position += sign * (at.share - 0.5) * steps.there;
  motion.velocity += sign * at.share_per_second * steps.there;
}

void add_tremor(PointMotion& motion, double seconds, std::uint64_t seed) {
  add_waves(motion, seconds, seed, {kTremorWaves, {0.06, 0.06, 0.04}, 3, 9});    // muscle tremor
  add_waves(motion, seconds, seed, {kSlowWaves, {0.15, 0.2, 0.3}, 0.05, 0.35});  // breathing and posture
}

/// Relative to the middle.
PointMotion motion_of(MotionKind kind, std::uint64_t seed, double seconds);

/// The four other motions one after the other, cross-faded.
PointMotion tour(std::uint64_t seed, double seconds) {
  struct Part {
    MotionKind kind;
    double from_s, until_s;
  };
  constexpr std::array<Part, 4> kParts = {
      {{MotionKind::sway, 0, 14}, {MotionKind::lean, 14, 26}, {MotionKind::still, 26, 32}, {MotionKind::turn, 32, 42}}};
  constexpr double kRound = 42, kFade = 1.5;
  const double at = seconds - std::floor(seconds / kRound) * kRound;
  PointMotion sum;
  for (const Part& part : kParts) {
    // A part fades in when it begins and out when the next one begins; the last part fades out at the start of the next round.
    for (const double local : {at, at + kRound}) {
      const StepProfile in = minimum_jerk(local - part.from_s, kFade);
      const StepProfile out = minimum_jerk(local - part.until_s, kFade);
      const double weight = in.share - out.share;
      const double weight_rate = in.share_per_second - out.share_per_second;
      if (weight == 0 && weight_rate == 0) continue;
      const PointMotion own = motion_of(part.kind, seed, seconds);
      sum.position += weight * own.position;
      sum.velocity += weight * own.velocity + weight_rate * own.position;
    }
  }
  return sum;
}

PointMotion motion_of(MotionKind kind, std::uint64_t seed, double seconds) {
  if (kind == MotionKind::tour) return tour(seed, seconds);
  PointMotion motion;
  add_tremor(motion, seconds, seed);
  switch (kind) {
    case MotionKind::still:
    case MotionKind::tour: break;
    case MotionKind::sway: add_waves(motion, seconds, seed, {kSwayWaves, {18, 3, 12}, 0.1, 0.6}); break;
    case MotionKind::lean: add_steps(motion, seconds, seed, {{15, -25, 150}, 5, 1.1}); break;
    case MotionKind::turn:
      // 150 mm in 0.7 s has a peak of 402 mm/s; with the slow sway it is about 412 mm/s.
      add_steps(motion, seconds, seed, {150 * Vector3d(0.985, -0.04, 0.168).normalized(), 4, 0.7});
      add_waves(motion, seconds, seed, {kSwayWaves, {2.5, 1, 1.5}, 0.15, 0.5});
      break;
  }
  return motion;
}

}  // namespace

Result<MotionKind> motion_kind_from(std::string_view name) {
  static constexpr std::array<std::string_view, 5> kNames = {"still", "sway", "lean", "turn", "tour"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<MotionKind>(i);
  return fail("", "there is no motion \"" + std::string(name) + "\"; the nearest is \"" + std::string(nearest_name(name, kNames)) +
                      "\" (known: still, sway, lean, turn, tour)");
}

HeadMotion::HeadMotion(MotionKind kind, std::uint64_t seed, const Vector3d& middle_mm, double speed)
    : kind_(kind), seed_(seed), middle_mm_(middle_mm), speed_(speed) {}

Vector3d HeadMotion::between_eyes_mm(double seconds) const { return middle_mm_ + motion_of(kind_, seed_, seconds * speed_).position; }

Vector3d HeadMotion::velocity_mm_s(double seconds) const { return speed_ * motion_of(kind_, seed_, seconds * speed_).velocity; }

}  // namespace prismesh::drivers::eye_tracker
