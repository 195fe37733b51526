#include "drivers/eye_tracker/head_motion.h"

#include <array>
#include <cmath>
#include <string>

#include "base/deterministic_math.h"
#include "base/nearest_name.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using Eigen::Vector3d;

/// A place and how fast it changes.
struct Moment {
  Vector3d place = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
};

/// A number of this seed's own for a purpose, evenly spread over 0..1 (the finaliser of SplitMix64).
double chance(std::uint64_t seed, std::uint64_t purpose) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u + purpose * 0xd1b54a32d192ed03u + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// Purposes of `chance`: steps count from 0 up, waves from here.
constexpr std::uint64_t kTremorWaves = 1'000'000'000'000;
constexpr std::uint64_t kSlowWaves = 2'000'000'000'000;
constexpr std::uint64_t kSwayWaves = 3'000'000'000'000;
constexpr std::uint64_t kFirstSide = 4'000'000'000'000;

/// Adds waves of seeded frequency and phase to all three axes; `rms_mm` is what each axis' waves amount to.
void add_waves(Moment& moment, double seconds, std::uint64_t seed, std::uint64_t purpose, const Vector3d& rms_mm, double low_hz,
               double high_hz) {
  constexpr int kWaves = 3;
  for (int axis = 0; axis < 3; ++axis) {
    const double amplitude = rms_mm[axis] * std::sqrt(2.0 / kWaves);
    for (int wave = 0; wave < kWaves; ++wave) {
      purpose += 2;
      // One wave in each third of the band, so that no seed has them all at one end.
      const double hz = low_hz + (high_hz - low_hz) * (wave + chance(seed, purpose)) / kWaves;
      const double pulse = 2 * kPi * hz;
      const double angle = pulse * seconds + 2 * kPi * chance(seed, purpose + 1);
      moment.place[axis] += amplitude * std::sin(angle);
      moment.velocity[axis] += amplitude * pulse * std::cos(angle);
    }
  }
}

/// The smoothest way from 0 to 1 in a given time: minimum jerk, as people's reaching and turning does (Flash and Hogan 1985). At rest
/// at both ends; its greatest slope is 1.875 / duration.
struct Glide {
  double share = 0;
  double share_per_second = 0;
};
Glide glide(double seconds, double duration) {
  const double u = seconds / duration;
  if (u <= 0) return {};
  if (u >= 1) return {1, 0};
  return {u * u * u * (10 + u * (6 * u - 15)), 30 * u * u * (1 - u) * (1 - u) / duration};
}

/// Step after step, there and back: one in each slot of time, beginning at a seeded moment of it.
struct Steps {
  Vector3d there;  ///< from one end to the other
  double slot_s;
  double duration_s;
};
void add_steps(Moment& moment, double seconds, std::uint64_t seed, const Steps& steps) {
  const double slot = std::floor(seconds / steps.slot_s);
  const auto number = static_cast<std::int64_t>(slot);
  const double start = chance(seed, static_cast<std::uint64_t>(number)) * (steps.slot_s - steps.duration_s);
  const Glide at = glide(seconds - slot * steps.slot_s - start, steps.duration_s);
  const bool goes_there = (number % 2 == 0) == (chance(seed, kFirstSide) < 0.5);
  const double sign = goes_there ? 1 : -1;
  moment.place += sign * (at.share - 0.5) * steps.there;
  moment.velocity += sign * at.share_per_second * steps.there;
}

void add_tremor(Moment& moment, double seconds, std::uint64_t seed) {
  add_waves(moment, seconds, seed, kTremorWaves, {0.06, 0.06, 0.04}, 3, 9);    // muscles
  add_waves(moment, seconds, seed, kSlowWaves, {0.15, 0.2, 0.3}, 0.05, 0.35);  // breath and posture
}

/// Relative to the middle.
Moment moment_of(MotionKind kind, std::uint64_t seed, double seconds);

/// The four others one after the other, cross-faded.
Moment tour(std::uint64_t seed, double seconds) {
  struct Part {
    MotionKind kind;
    double from_s, until_s;
  };
  constexpr std::array<Part, 4> kParts = {
      {{MotionKind::sway, 0, 14}, {MotionKind::lean, 14, 26}, {MotionKind::still, 26, 32}, {MotionKind::turn, 32, 42}}};
  constexpr double kRound = 42, kFade = 1.5;
  const double at = seconds - std::floor(seconds / kRound) * kRound;
  Moment sum;
  for (const Part& part : kParts) {
    // A part fades in as it begins and out as the next begins; the last one's fading out stands at the round's begin.
    for (const double local : {at, at + kRound}) {
      const Glide in = glide(local - part.from_s, kFade);
      const Glide out = glide(local - part.until_s, kFade);
      const double weight = in.share - out.share;
      const double weight_rate = in.share_per_second - out.share_per_second;
      if (weight == 0 && weight_rate == 0) continue;
      const Moment own = moment_of(part.kind, seed, seconds);
      sum.place += weight * own.place;
      sum.velocity += weight * own.velocity + weight_rate * own.place;
    }
  }
  return sum;
}

Moment moment_of(MotionKind kind, std::uint64_t seed, double seconds) {
  if (kind == MotionKind::tour) return tour(seed, seconds);
  Moment moment;
  add_tremor(moment, seconds, seed);
  switch (kind) {
    case MotionKind::still:
    case MotionKind::tour: break;
    case MotionKind::sway: add_waves(moment, seconds, seed, kSwayWaves, {18, 3, 12}, 0.1, 0.6); break;
    case MotionKind::lean: add_steps(moment, seconds, seed, {{15, -25, 150}, 5, 1.1}); break;
    case MotionKind::turn:
      // 150 mm in 0.7 s: 402 mm/s; the slow sway beside it makes the peak some 412.
      add_steps(moment, seconds, seed, {150 * Vector3d(0.985, -0.04, 0.168).normalized(), 4, 0.7});
      add_waves(moment, seconds, seed, kSwayWaves, {2.5, 1, 1.5}, 0.15, 0.5);
      break;
  }
  return moment;
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

Vector3d HeadMotion::between_eyes_mm(double seconds) const { return middle_mm_ + moment_of(kind_, seed_, seconds * speed_).place; }

Vector3d HeadMotion::velocity_mm_s(double seconds) const { return speed_ * moment_of(kind_, seed_, seconds * speed_).velocity; }

}  // namespace prismesh::drivers::eye_tracker
