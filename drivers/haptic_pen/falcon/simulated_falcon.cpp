#include "drivers/haptic_pen/falcon/simulated_falcon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/ftdi.h"
#include "drivers/haptic_pen/falcon/kinematics.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr std::size_t kHeaderBytes = 22;
constexpr std::int64_t kNsPerByteRunning = 10'000'000'000 / 1'500'000;
/// Modem and line status as such a chip sends them at rest.
constexpr std::byte kModemStatus{0x01}, kLineStatus{0x60};

}  // namespace

SimulatedFalcon::SimulatedFalcon(const SimulatedFalconOptions& options, HandSource hand, FalconWatcher watcher)
    : options_(options), pen_(options.pen, std::move(hand)), watcher_(std::move(watcher)) {
  if (options_.runs) state_ = State::runs;
  if (options_.homed) homed_ = kAllHomed;
}

bool SimulatedFalcon::control(std::int64_t now_ns, const port::UsbControl& request) {
  if (request.type != ftdi::kToDevice) return false;
  move(now_ns);
  switch (request.request) {
    case ftdi::kReset:
      if (request.value == ftdi::kPurgeReceived) answers_.clear();
      return request.value <= ftdi::kPurgeToSend;
    case ftdi::kModem: {
      const bool low_dtr = request.value == ftdi::kDtrLow, high_dtr = request.value == ftdi::kDtrHigh;
      if (request.value == ftdi::kRtsLow) rts_low_ = true;
      if (high_dtr && !dtr_ && rts_low_) {
        // The edge resets the processor.
        lose_power();
        state_ = State::greets;
      }
      if (low_dtr && state_ == State::waits_for_lock) heard_.clear();
      if (low_dtr || high_dtr) dtr_ = high_dtr;
      return low_dtr || high_dtr || request.value == ftdi::kRtsLow;
    }
    case ftdi::kSetBaud: baud_ = request.value; return true;
    case ftdi::kSetLatency: latency_ns_ = request.value * std::int64_t{1'000'000}; return request.value >= 1 && request.value <= 255;
    case ftdi::kSetData: return request.value == ftdi::kEightNoneOne;
    case ftdi::kSetFlow: return request.value == 0;
    default: return false;
  }
}

void SimulatedFalcon::receive(std::int64_t now_ns, std::span<const std::byte> bytes) {
  move(now_ns);
  if (deaf_) return;
  for (const std::byte byte : bytes) take(now_ns, byte);
}

void SimulatedFalcon::take(std::int64_t now_ns, std::byte byte) {
  switch (state_) {
    case State::off:
    case State::refuses: return;
    case State::greets:
      if (baud_ != ftdi::kBaud9600) return;
      heard_.push_back(byte);
      if (heard_.size() > 3) heard_.erase(heard_.begin());
      if (heard_ != std::vector{std::byte{0x0A}, std::byte{0x43}, std::byte{0x0D}}) return;
      for (const unsigned each : {0x0Au, 0x44u, 0x2Cu, 0x0Du}) put(now_ns, static_cast<std::byte>(each));
      state_ = State::waits_for_lock;
      return;
    case State::waits_for_lock:
      if (dtr_ || baud_ != ftdi::kBaudLoader || byte != std::byte{'A'}) return;
      put(now_ns, byte);
      loaded_.clear();
      words_left_ = 0;
      state_ = State::loads;
      return;
    case State::loads:
      if (baud_ == ftdi::kBaudLoader) load(now_ns, byte);
      return;
    case State::runs:
      if (baud_ != ftdi::kBaudRunning) return;
      if (const auto packet = finder_.take(byte))
        if (const auto force = decode_force(*packet)) answer_force(now_ns, *force);
  }
}

/// As the loader does: it doesn't know the length before it has the blocks.
void SimulatedFalcon::load(std::int64_t now_ns, std::byte byte) {
  put(now_ns, loaded_.size() == damaged_echo_ ? byte ^ std::byte{1} : byte);
  loaded_.push_back(byte);
  const std::size_t count = loaded_.size();
  const auto last_word = [&] {
    return std::to_integer<std::size_t>(loaded_[count - 2]) | std::to_integer<std::size_t>(loaded_[count - 1]) << 8;
  };
  if (count == 2 && last_word() != 0x08AA) state_ = State::refuses;
  if (count <= kHeaderBytes || count % 2 != 0) return;
  if (words_left_ > 0) {
    --words_left_;
    return;
  }
  words_left_ = last_word() == 0 ? 0 : last_word() + 2;  // and the two of its address
  if (words_left_ > 0) return;
  state_ = State::runs;
  finder_.clear();
}

void SimulatedFalcon::answer_force(std::int64_t now_ns, const ForcePacket& packet) {
  if (watcher_) watcher_(now_ns, packet);
  told_ns_ = now_ns;
  const auto angles = inverse_kinematics(kMiddle + pen_.position_mm() * 1e-3);
  const auto place = angles ? forward_kinematics(*angles, kMiddle + pen_.position_mm() * 1e-3) : std::nullopt;
  if (place) {
    // Torques that the motors make, as a force at the grip.
    Eigen::Vector3d torque;
    for (Eigen::Index arm = 0; arm < 3; ++arm) torque[arm] = -packet.motors[static_cast<std::size_t>(arm)] / kUnitsPerNewtonMetre;
    newton_ = place->jacobian.transpose().inverse() * torque;
  }
  const std::int64_t until_ns =
      options_.silence == Silence::holds_last_force ? std::numeric_limits<std::int64_t>::max() / 2 : now_ns + options_.lets_go_after_ns;
  pen_.send(now_ns, {newton_, until_ns});
  if (!packet.homing) homed_ = 0;
  if (answers_to_lose_ > 0) {
    --answers_to_lose_;
    return;
  }
  PosePacket pose;
  for (std::size_t arm = 0; arm < 3; ++arm) pose.encoders[arm] = static_cast<std::int16_t>(last_counts_[arm] - origin_[arm]);
  pose.buttons = static_cast<std::uint8_t>(pen_.buttons());
  pose.homed = homed_;
  std::int64_t due_ns = now_ns + late_ns_;
  for (const std::byte byte : encode(pose)) put(due_ns += kNsPerByteRunning, byte);
}

void SimulatedFalcon::put(std::int64_t now_ns, std::byte byte) { answers_.push_back({byte, now_ns}); }

void SimulatedFalcon::inject(std::int64_t now_ns, std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes) put(now_ns, byte);
}

std::size_t SimulatedFalcon::send(std::int64_t now_ns, std::span<std::byte> to) {
  move(now_ns);
  std::size_t ready = 0;
  while (ready < answers_.size() && ready < options_.piece_bytes && answers_[ready].due_ns <= now_ns) ++ready;
  // A full packet goes at once, the rest when the chip's timer ends: with nothing but the status if there is nothing.
  if (ready < options_.piece_bytes && now_ns < packet_due_ns_) return 0;
  packet_due_ns_ = now_ns + latency_ns_;
  to[0] = kModemStatus;
  to[1] = kLineStatus;
  for (std::size_t i = 0; i < ready; ++i) {
    to[ftdi::kStatusBytes + i] = answers_.front().byte;
    answers_.pop_front();
  }
  return ftdi::kStatusBytes + ready;
}

void SimulatedFalcon::move(std::int64_t now_ns) {
  (void)pen_.read(now_ns);
  if (options_.silence == Silence::lets_go && now_ns - told_ns_ > options_.lets_go_after_ns) newton_.setZero();
  const auto angles = inverse_kinematics(kMiddle + pen_.position_mm() * 1e-3);
  if (!angles) return;
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const int count = static_cast<int>(std::lround(count_of_angle((*angles)[static_cast<Eigen::Index>(arm)])));
    // The mark of an arm is where its true count is 0.
    const bool passed = placed_ && (count <= 0) != (last_counts_[arm] <= 0);
    if (!placed_ && (homed_ & 1u << arm) == 0) origin_[arm] = count;  // where the arm is when the power comes
    if (passed && state_ == State::runs && (homed_ & 1u << arm) == 0) {
      homed_ = static_cast<std::uint8_t>(homed_ | 1u << arm);
      origin_[arm] = 0;
    }
    last_counts_[arm] = count;
  }
  placed_ = true;
}

void SimulatedFalcon::lose_power() {
  state_ = State::off;
  homed_ = 0;
  origin_ = last_counts_;
  heard_.clear();
  answers_.clear();
  finder_.clear();
  newton_.setZero();
  pen_.send(told_ns_, {});
}

std::vector<std::byte> pretended_firmware(std::size_t words) {
  std::vector<std::byte> bytes;
  const auto word = [&](std::size_t value) {
    bytes.push_back(static_cast<std::byte>(value & 0xFF));
    bytes.push_back(static_cast<std::byte>(value >> 8 & 0xFF));
  };
  word(0x08AA);
  for (int i = 0; i < 8; ++i) word(0);
  word(0x003F), word(0x8002);  // where to begin
  for (const std::size_t count : {words / 2, words - words / 2}) {
    if (count == 0) continue;
    word(count), word(0x003F), word(0x8002);
    for (std::size_t i = 0; i < count; ++i) word((i * 40'503 + count) & 0xFFFF);
  }
  word(0);
  return bytes;
}

HandSource homing_hand(HandSource then) {
  return [then = std::move(then)](double seconds) {
    constexpr double kRest = 3.0, kPull = 1.0, kPush = 1.0;
    if (seconds > kRest + kPull + kPush) return then(seconds - kRest - kPull - kPush);
    SimulatedHand hand;
    const double pulled = std::clamp((seconds - kRest) / kPull, 0.0, 1.0) - std::clamp((seconds - kRest - kPull) / kPush, 0.0, 1.0);
    hand.goal_mm = {0, 0, 38 * pulled};
    return hand;
  };
}

}  // namespace prismesh::drivers::haptic_pen::falcon
