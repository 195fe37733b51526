#include "drivers/prism_servo/dynamixel/simulated_servo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::uint8_t kOverloadBit = 1U << 5U;
/// Factory defaults of the XM430-W210.
struct Default {
  Register which;
  std::uint32_t value;
};
constexpr std::array<Default, 10> kKept = {{{kFirmwareVersion, 45},
                                            {kDriveMode, 0},
                                            {kOperatingMode, kPositionMode},
                                            {kHomingOffset, 0},
                                            {kVelocityLimit, 330},
                                            {kMaxPositionLimit, 4095},
                                            {kMinPositionLimit, 0},
                                            {kShutdown, 52},
                                            {{31, 1}, 80},
                                            {{13, 1}, 2}}};
/// Registers that a host may write. All others are refused, so that tests notice a faulty driver.
constexpr std::array<Register, 16> kWritable = {
    kId,           kBaudRate,          kReturnDelayTime,  kDriveMode,           kOperatingMode,
    kHomingOffset, kVelocityLimit,     kMaxPositionLimit, kMinPositionLimit,    kShutdown,
    kTorqueEnable, kStatusReturnLevel, kBusWatchdog,      kProfileAcceleration, kProfileVelocity,
    kGoalPosition};
/// Existing address ranges (first, one past the last).
struct Range {
  std::uint16_t from, to;
};
constexpr std::array<Range, 12> kReadable = {
    {{0, 14}, {20, 28}, {31, 40}, {44, 56}, {63, 66}, {68, 71}, {76, 86}, {88, 92}, {98, 99}, {100, 136}, {136, 148}, {168, 252}}};

bool readable(std::size_t from, std::size_t to) {
  return std::any_of(kReadable.begin(), kReadable.end(), [&](const Range& range) { return from >= range.from && to <= range.to; });
}

}  // namespace

SimulatedServo::SimulatedServo(port::BytePort& port, const SimulatedServoSettings& settings) : port_(port), settings_(settings) {
  factory_registers();
  motor_mm_ = mask_mm_ = profile_mm_ = settings.start_mm;
  port_.set_baud(settings.baud);
  update_motion_registers();
}

void SimulatedServo::factory_registers() {
  set_value(kModelNumber, settings_.model);
  set_value(kId, settings_.id);
  set_value(kBaudRate, static_cast<std::uint32_t>(std::max(0, baud_code(settings_.baud))));
  set_value(kReturnDelayTime, settings_.return_delay);
  for (const Default& kept : kKept) set_value(kept.which, kept.value);
  reset_volatile();
}

void SimulatedServo::reset_volatile() {
  std::fill(table_.begin() + kFirstVolatileAddress, table_.end(), std::uint8_t{0});
  set_value(kStatusReturnLevel, kAnswerAll);
}

std::uint32_t SimulatedServo::value(Register which) const { return number_at(table_, which.address, which.size); }

void SimulatedServo::set_value(Register which, std::uint32_t value) {
  for (std::size_t i = 0; i < which.size; ++i) table_[which.address + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void SimulatedServo::set_power(bool on) {
  if (on == powered_) return;
  powered_ = on;
  if (on) boot(now_ns_);
}

void SimulatedServo::boot(std::int64_t now_ns) {
  reset_volatile();
  parser_.reset();
  answers_waiting_ = 0;
  boot_until_ns_ = now_ns + settings_.boot_ns;
  port_.set_baud(kBauds[std::min<std::size_t>(value(kBaudRate), kBauds.size() - 1)]);
}

void SimulatedServo::raise_hardware_error(std::uint8_t bits) {
  set_value(kHardwareErrorStatus, value(kHardwareErrorStatus) | bits);
  if ((value(kShutdown) & bits) != 0) set_value(kTorqueEnable, 0);
}

void SimulatedServo::step(std::int64_t now_ns) {
  if (!started_) {
    started_ = true;
    now_ns_ = last_instruction_ns_ = now_ns;
  }
  read_instructions(now_ns);
  send_due(now_ns);
  check_watchdog(now_ns);
  simulate_motor(now_ns);
  now_ns_ = now_ns;
}

void SimulatedServo::read_instructions(std::int64_t now_ns) {
  std::array<std::byte, kMaxPacketLength> bytes;
  while (true) {
    const port::PortCount count = port_.read(bytes);
    if (count.bytes == 0) break;
    if (!powered_ || now_ns < boot_until_ns_) continue;
    if (settings_.echoes) port_.write(std::span(bytes).first(count.bytes));
    parser_.take(std::span(bytes).first(count.bytes));
    while (const Packet* packet = parser_.next()) execute(*packet, now_ns);
  }
  counts_.bad_packets = parser_.bad_packets();
}

void SimulatedServo::execute(const Packet& packet, std::int64_t now_ns) {
  if (packet.id != value(kId) && packet.id != kBroadcastId) return;
  if (packet.instruction == Instruction::status) return;
  ++counts_.instructions;
  last_instruction_ns_ = now_ns;
  switch (packet.instruction) {
    case Instruction::ping: return ping(now_ns);
    case Instruction::read: return read(packet, now_ns);
    case Instruction::write: return write(packet, now_ns);
    case Instruction::reboot:
      if (value(kStatusReturnLevel) == kAnswerAll) answer(now_ns, Refusal::none, {});
      rebooting_ = true;
      return;
    default:
      ++counts_.refused;
      if (value(kStatusReturnLevel) == kAnswerAll) answer(now_ns, Refusal::unknown_instruction, {});
  }
}

void SimulatedServo::ping(std::int64_t now_ns) {
  const std::array<std::uint8_t, 3> who = {table_[0], table_[1], table_[kFirmwareVersion.address]};
  answer(now_ns, Refusal::none, who);
}

void SimulatedServo::read(const Packet& packet, std::int64_t now_ns) {
  if (value(kStatusReturnLevel) < kAnswerReads || packet.id == kBroadcastId) return;
  const std::size_t from = number_at(packet.data(), 0, 2), count = number_at(packet.data(), 2, 2);
  if (packet.count != 4 || count == 0 || count > kMaxParameters || !readable(from, from + count)) {
    ++counts_.refused;
    return answer(now_ns, Refusal::access, {});
  }
  answer(now_ns, Refusal::none, std::span(table_).subspan(from, count));
}

void SimulatedServo::write(const Packet& packet, std::int64_t now_ns) {
  const std::uint32_t address = number_at(packet.data(), 0, 2);
  const auto found = std::find_if(kWritable.begin(), kWritable.end(), [&](const Register& which) { return which.address == address; });
  Refusal refusal = Refusal::access;
  if (found != kWritable.end()) {
    refusal = Refusal::length;
    if (packet.count == 2U + found->size) refusal = write_register(*found, number_at(packet.data(), 2, found->size));
  }
  if (refusal != Refusal::none) ++counts_.refused;
  // The status level after the write decides; the manual doesn't specify this.
  if (value(kStatusReturnLevel) == kAnswerAll && packet.id != kBroadcastId) answer(now_ns, refusal, {});
}

Refusal SimulatedServo::check(Register which, std::uint32_t value_to_write) const {
  const bool volatile_register = which.address >= kFirstVolatileAddress;
  if (!volatile_register && torque()) return Refusal::access;
  if (which == kBaudRate && value_to_write >= kBauds.size()) return Refusal::range;
  if (which == kId && value_to_write > kMaxId) return Refusal::range;
  if (which == kReturnDelayTime && value_to_write > 254) return Refusal::range;
  if (which == kStatusReturnLevel && value_to_write > kAnswerAll) return Refusal::range;
  if (which == kTorqueEnable && value_to_write > 1) return Refusal::range;
  if (which == kBusWatchdog && value_to_write > 127) return Refusal::range;
  if ((which == kMaxPositionLimit || which == kMinPositionLimit) && value_to_write > 4095) return Refusal::range;
  if (which == kProfileVelocity && value_to_write > 32'767) return Refusal::range;
  if (which == kProfileVelocity && value_to_write > value(kVelocityLimit)) return Refusal::limit;
  if (which != kGoalPosition) return Refusal::none;
  if (watchdog_tripped()) return Refusal::range;
  const auto goal = static_cast<std::int32_t>(value_to_write);
  if (goal < static_cast<std::int32_t>(value(kMinPositionLimit)) || goal > static_cast<std::int32_t>(value(kMaxPositionLimit)))
    return Refusal::limit;
  return Refusal::none;
}

Refusal SimulatedServo::write_register(Register which, std::uint32_t value_to_write) {
  const Refusal refusal = check(which, value_to_write);
  if (which == kGoalPosition && refusal == Refusal::limit) ++counts_.goals_beyond_limits;
  if (refusal != Refusal::none) return refusal;
  if (which.address < kFirstVolatileAddress) ++counts_.eeprom_writes;
  // After a shutdown only a reboot enables torque again.
  if (which == kTorqueEnable && value_to_write == 1 && (value(kHardwareErrorStatus) & value(kShutdown)) != 0) return Refusal::failed;
  if (which == kTorqueEnable && value_to_write == 1 && !torque()) {
    profile_mm_ = motor_mm_;
    set_value(kGoalPosition, value(kPresentPosition));
  }
  if (which == kGoalPosition) {
    if (!torque()) return Refusal::none;  // while torque is off, the goal stays at the present position
    ++counts_.goals;
  }
  set_value(which, value_to_write);
  if (which == kBaudRate) baud_after_answer_ = kBauds[value_to_write];
  return Refusal::none;
}

void SimulatedServo::answer(std::int64_t now_ns, Refusal refusal, std::span<const std::uint8_t> data) {
  if (answers_waiting_ == answers_.size()) return;
  Answer& next = answers_[answers_waiting_];
  const std::uint8_t alert = value(kHardwareErrorStatus) != 0 ? kAlertBit : std::uint8_t{0};
  next.size = encode_status(static_cast<std::uint8_t>(value(kId)), static_cast<std::uint8_t>(static_cast<std::uint8_t>(refusal) | alert),
                            data, next.bytes);
  next.due_ns = now_ns + kReturnDelayUnitNs * value(kReturnDelayTime);
  if (next.size > 0) ++answers_waiting_;
}

void SimulatedServo::send_due(std::int64_t now_ns) {
  if (!powered_) return;
  std::size_t sent = 0;
  for (; sent < answers_waiting_ && answers_[sent].due_ns <= now_ns; ++sent) {
    if (muted_) continue;
    port_.write(std::span(answers_[sent].bytes).first(answers_[sent].size));
    ++counts_.answers;
  }
  std::move(answers_.begin() + static_cast<std::ptrdiff_t>(sent), answers_.begin() + static_cast<std::ptrdiff_t>(answers_waiting_),
            answers_.begin());
  answers_waiting_ -= sent;
  if (answers_waiting_ > 0) return;
  // The answer to a change of the baud rate is sent at the old rate; the manual doesn't specify this.
  if (baud_after_answer_ > 0) port_.set_baud(baud_after_answer_);
  baud_after_answer_ = 0;
  if (rebooting_) boot(now_ns);
  rebooting_ = false;
}

void SimulatedServo::check_watchdog(std::int64_t now_ns) {
  const std::uint32_t limit = value(kBusWatchdog);
  if (!powered_ || !torque() || limit == 0 || limit == kWatchdogTripped) return;
  if (now_ns - last_instruction_ns_ <= static_cast<std::int64_t>(limit) * kWatchdogUnitNs) return;
  set_value(kBusWatchdog, kWatchdogTripped);
  set_value(kProfileAcceleration, 0);
  set_value(kProfileVelocity, 0);
  profile_mm_ = motor_mm_;
  set_value(kGoalPosition, value(kPresentPosition));
  ++counts_.watchdog_trips;
}

void SimulatedServo::simulate_motor(std::int64_t now_ns) {
  // Integrates in small steps, whatever the caller's step.
  constexpr std::int64_t kStepNs = 250'000;
  std::int64_t at = now_ns_;
  while (at < now_ns) {
    const std::int64_t next = std::min(now_ns, at + kStepNs);
    move_motor(static_cast<double>(next - at) * 1e-9);
    at = next;
  }
  move_mask();
  check_load(now_ns);
  update_motion_registers();
}

double SimulatedServo::speed_limit_mm_s() const {
  const std::uint32_t units = value(kProfileVelocity);
  if (units == 0) return settings_.speed_mm_s;
  return std::min(settings_.speed_mm_s, units * kTurnsPerMinutePerUnit / 60 * settings_.travel_mm_per_turn);
}

void SimulatedServo::move_motor(double seconds) {
  const double before = motor_mm_;
  if (powered_ && torque()) {
    const double goal = mm_from(static_cast<std::int32_t>(value(kGoalPosition)));
    const double max_profile_step = speed_limit_mm_s() * seconds;
    profile_mm_ += std::clamp(goal - profile_mm_, -max_profile_step, max_profile_step);
    const double lag_s = std::max(1e-4, settings_.lag_ms * 1e-3);
    const double max_step = settings_.speed_mm_s * seconds;
    const double step = (profile_mm_ - motor_mm_) * (1 - std::exp(-seconds / lag_s));
    if (!jammed_) motor_mm_ = std::clamp(motor_mm_ + std::clamp(step, -max_step, max_step), -settings_.stop_mm, settings_.stop_mm);
  } else {
    profile_mm_ = motor_mm_;
  }
  if (seconds > 0) velocity_mm_s_ = (motor_mm_ - before) / seconds;
}

void SimulatedServo::move_mask() {
  const double half_backlash = settings_.backlash_mm / 2;
  mask_mm_ = std::clamp(mask_mm_, motor_mm_ - half_backlash, motor_mm_ + half_backlash);
}

void SimulatedServo::check_load(std::int64_t now_ns) {
  if (!torque() || std::abs(profile_mm_ - motor_mm_) < settings_.overload_mm) {
    overload_since_ns_ = kNever;
    return;
  }
  if (overload_since_ns_ == kNever) overload_since_ns_ = now_ns;
  if (now_ns - overload_since_ns_ > settings_.overload_after_ns) raise_hardware_error(kOverloadBit);
}

void SimulatedServo::update_motion_registers() {
  set_value(kPresentPosition, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(ticks_from(motor_mm_)))));
  const double sign = settings_.reversed ? -1 : 1;
  const double units = sign * velocity_mm_s_ / settings_.travel_mm_per_turn * 60 / kTurnsPerMinutePerUnit;
  set_value(kPresentVelocity, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(units))));
  set_value(kMoving, std::abs(units) > 10 ? 1 : 0);
  if (!torque()) set_value(kGoalPosition, value(kPresentPosition));
}

double SimulatedServo::ticks_from(double mm) const {
  return settings_.zero_ticks + (settings_.reversed ? -1 : 1) * mm / settings_.travel_mm_per_turn * kTicksPerTurn;
}

double SimulatedServo::mm_from(double ticks) const {
  return (settings_.reversed ? -1 : 1) * (ticks - settings_.zero_ticks) / kTicksPerTurn * settings_.travel_mm_per_turn;
}

}  // namespace prismesh::drivers::prism_servo::dynamixel
