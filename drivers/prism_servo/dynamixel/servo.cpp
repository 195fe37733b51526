#include "drivers/prism_servo/dynamixel/servo.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.h"

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

constexpr int kPingsPerBaud = 2;
constexpr int kMaxWriteAttempts = 3;
constexpr int kMaxUnansweredRequests = 4;
constexpr int kTicksBetweenChecks = 16;
constexpr std::size_t kPingAnswerData = 3;
constexpr std::size_t kMotionData = 8;  // present velocity, then present position
constexpr std::size_t kStatusFrame = kPacketFrame + 1;
constexpr double kBitsPerByte = 10;  // 8N1
/// Max. delay that adapters and schedulers add to an answer: an FTDI chip buffers bytes for 16 ms by default.
constexpr std::int64_t kMaxAdapterDelayNs = 30'000'000;
/// Line time reserved after an exchange: the servo's turn-around, with a return delay of max. 0.5 ms.
constexpr std::int64_t kTurnAroundNs = 700'000;
constexpr std::int64_t kUsbFrameNs = 1'000'000;
constexpr std::int64_t kRebootNs = 500'000'000;
constexpr std::int64_t kSearchPauseNs = 150'000'000;
constexpr std::int64_t kRetryPauseNs = 1'000'000'000;

/// Torque and the LED register next to it: two bytes, so that a late answer can't be taken for the watchdog's.
constexpr Register kTorqueCheck{kTorqueEnable.address, 2};

/// The registers to set up, in this order: first those that make the servo answer, then the EEPROM while torque is off, then the rest.
constexpr std::array<Register, 15> kSetup = {
    kStatusReturnLevel, kBusWatchdog,   kTorqueEnable,        kHardwareErrorStatus, kBaudRate,
    kReturnDelayTime,   kDriveMode,     kOperatingMode,       kHomingOffset,        kMaxPositionLimit,
    kMinPositionLimit,  kVelocityLimit, kProfileAcceleration, kProfileVelocity,     kBusWatchdog};

/// Baud rates at which a servo may have been left, the most probable first.
constexpr std::array<int, 8> kCandidateBauds = {57'600, 1'000'000, 115'200, 2'000'000, 3'000'000, 4'000'000, 4'500'000, 9'600};

std::uint8_t watchdog_units(const ServoSettings& settings) {
  return static_cast<std::uint8_t>(std::clamp<std::int64_t>((settings.watchdog_ns + kWatchdogUnitNs - 1) / kWatchdogUnitNs, 1, 127));
}

double ticks_of(const ServoSettings& settings, double mm) { return mm / settings.travel_mm_per_turn * kTicksPerTurn; }

}  // namespace

Result<ServoSettings> servo_settings(const settings::PrismServoSettings& from) {
  const auto bad = [&](std::string sentence) { return fail(from.port, std::move(sentence)); };
  if (from.id < 0 || from.id > kMaxId) return bad("prism_servo.id is " + std::to_string(from.id) + "; a servo's id is 0 to 252.");
  if (baud_code(from.baud) < 0)
    return bad("prism_servo.baud is " + std::to_string(from.baud) +
               "; a servo can do 9600, 57600, 115200, 1000000, 2000000, 3000000, 4000000 or 4500000.");
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(from.travel_mm_per_turn) || !positive(from.travel_mm) || !positive(from.speed_mm_s) || !std::isfinite(from.lag_ms) ||
      from.lag_ms < 0)
    return bad("prism_servo's travel_mm_per_turn, travel_mm and speed_mm_s have to be above zero, lag_ms at least zero.");
  ServoSettings settings;
  settings.id = static_cast<std::uint8_t>(from.id);
  settings.baud = from.baud;
  settings.travel_mm_per_turn = from.travel_mm_per_turn;
  settings.reversed = from.reversed;
  settings.zero_ticks = from.zero_ticks;
  settings.travel_mm = from.travel_mm;
  settings.speed_mm_s = from.speed_mm_s;
  settings.lag_ns = nanoseconds(from.lag_ms);
  const double reach = ticks_of(settings, from.travel_mm);
  if (!(from.zero_ticks - reach >= 0 && from.zero_ticks + reach <= kTicksPerTurn - 1))
    return bad(
        "prism_servo's travel_mm on both sides of zero_ticks leaves the encoder's turn (0 to 4095): move the horn so that the middle is "
        "near "
        "2048, or take a smaller travel_mm or a larger travel_mm_per_turn.");
  return settings;
}

std::int32_t ticks_from_mm(const ServoSettings& settings, double mm) {
  if (std::isnan(mm)) mm = 0;
  const double held = std::clamp(mm, -settings.travel_mm, settings.travel_mm);
  const double sign = settings.reversed ? -1 : 1;
  return settings.zero_ticks + static_cast<std::int32_t>(std::lround(sign * ticks_of(settings, held)));
}

double mm_from_ticks(const ServoSettings& settings, std::int32_t ticks) {
  const double sign = settings.reversed ? -1 : 1;
  return sign * (static_cast<double>(ticks) - settings.zero_ticks) / kTicksPerTurn * settings.travel_mm_per_turn;
}

std::uint32_t velocity_units(const ServoSettings& settings, double mm_s) {
  const double units = mm_s / settings.travel_mm_per_turn * 60 / kTurnsPerMinutePerUnit;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(units), 1.0, 32'767.0));
}

Servo::Servo(port::BytePort& port, const ServoSettings& settings) : port_(port), settings_(settings) { port_.discard_input(); }

PrismServo::Tick Servo::tick(std::int64_t now_ns, double goal_mm, bool powered) {
  tick_.fresh = false;
  tick_.status = port::PortStatus::ok;
  out_size_ = 0;
  read_answers(now_ns);
  expire(now_ns);
  if (tick_.status != port::PortStatus::gone && now_ns >= line_free_ns_) {
    switch (stage_) {
      case Stage::searching: search(now_ns); break;
      case Stage::setting_up: set_up(now_ns); break;
      case Stage::changing_baud: change_baud(now_ns); break;
      case Stage::running: run(now_ns, goal_mm, powered); break;
      case Stage::alarm: watch_alarm(now_ns, powered); break;
      case Stage::rebooting:
      case Stage::refused: begin_search(); break;
    }
    flush(now_ns);
  }
  counts_.bad_packets = parser_.bad_packets();
  if (tick_.status == port::PortStatus::gone) tick_.phase = ServoPhase::absent;
  return tick_;
}

std::int64_t Servo::line_ns(std::size_t bytes) const {
  return std::llround(static_cast<double>(bytes) * kBitsPerByte * 1e9 / std::max(line_baud_, 1));
}

// --- reading answers ---

void Servo::read_answers(std::int64_t now_ns) {
  std::array<std::byte, kMaxPacketLength> bytes;
  // Bounded, so that a continuous stream of bytes can't block the tick.
  for (int round = 0; round < 8; ++round) {
    const port::PortCount count = port_.read(bytes);
    parser_.take(std::span(bytes).first(count.bytes));
    while (const Packet* packet = parser_.next()) take(*packet, now_ns);
    if (count.status == port::PortStatus::gone) tick_.status = count.status;
    if (count.bytes < bytes.size()) return;
  }
}

void Servo::take(const Packet& packet, std::int64_t now_ns) {
  // Some adapters echo the instructions.
  if (packet.instruction != Instruction::status || packet.id != settings_.id) return;
  ++counts_.answers;
  if (packet.alert) check_error_next_ = true;
  const Request request = request_;
  if (request.kind == RequestKind::nothing) return;
  if (packet.error != 0) return take_refusal(request, now_ns);
  const std::size_t expected = request.kind == RequestKind::ping     ? kPingAnswerData
                               : request.kind == RequestKind::motion ? kMotionData
                                                                     : request.which.size;
  if (packet.count != expected) return;
  request_.kind = RequestKind::nothing;
  unanswered_requests_ = 0;
  line_free_ns_ = now_ns;
  typical_answer_ns_ = std::max(now_ns - request.sent_ns, typical_answer_ns_ - typical_answer_ns_ / 64);
  switch (request.kind) {
    case RequestKind::ping: return take_ping(packet, now_ns);
    case RequestKind::motion: return take_motion(packet, request, now_ns);
    case RequestKind::value: return take_value(request.which, number_at(packet.data(), 0, request.which.size), now_ns);
    case RequestKind::nothing: return;
  }
}

/// Handles an error answer to a request: the servo won't send data for it.
void Servo::take_refusal(const Request& request, std::int64_t now_ns) {
  request_.kind = RequestKind::nothing;
  unanswered_requests_ = 0;
  line_free_ns_ = now_ns;
  if (stage_ == Stage::setting_up) refuse(ServoTrouble::refused, request.which.address, now_ns);
}

void Servo::take_ping(const Packet& packet, std::int64_t now_ns) {
  model_ = static_cast<std::uint16_t>(number_at(packet.data(), 0, 2));
  found_baud_ = line_baud_;
  if (model_name(model_).empty()) return refuse(ServoTrouble::other_model, model_, now_ns);
  begin_setup();
}

void Servo::take_motion(const Packet& packet, const Request& request, std::int64_t now_ns) {
  const auto velocity = static_cast<std::int32_t>(number_at(packet.data(), 0, 4));
  const auto ticks = static_cast<std::int32_t>(number_at(packet.data(), 4, 4));
  const double sign = settings_.reversed ? -1 : 1;
  // The servo sampled after the request had arrived and before the answer was sent. Most of the time between is waiting for this tick, so
  // half of a USB frame after the request is the best estimate: requests aren't delayed by more than a USB frame.
  const std::int64_t latest_ns = std::max(request.transmitted_ns, now_ns - line_ns(request.answer_bytes));
  const std::int64_t sampled_ns = request.transmitted_ns + std::min((latest_ns - request.transmitted_ns) / 2, kUsbFrameNs / 2);
  // An answer earlier than its request is a late answer to an older request.
  tick_.reading.measured_ns = std::min(sampled_ns, now_ns);
  tick_.reading.position_mm = mm_from_ticks(settings_, ticks);
  tick_.reading.velocity_mm_s = sign * velocity * kTurnsPerMinutePerUnit / 60 * settings_.travel_mm_per_turn;
  tick_.fresh = true;
}

void Servo::take_value(Register which, std::uint32_t value, std::int64_t now_ns) {
  if (stage_ == Stage::setting_up) return take_setup_value(value, now_ns);
  if (stage_ == Stage::running || stage_ == Stage::alarm) take_check(which, value);
}

void Servo::take_setup_value(std::uint32_t value, std::int64_t now_ns) {
  const Register which = kSetup[step_];
  bool done = value == required_value(which);
  if (which == kHardwareErrorStatus) {
    if (value != 0) return enter_alarm(static_cast<std::uint8_t>(value));
    done = true;
  }
  if (which == kVelocityLimit) {
    if (value < required_value(kProfileVelocity)) return refuse(ServoTrouble::too_slow, which.address, now_ns);
    done = true;
  }
  if (!done) {
    if (++write_attempts_ > kMaxWriteAttempts) return refuse(ServoTrouble::refused, which.address, now_ns);
    write_next_ = true;
    return;
  }
  write_attempts_ = 0;
  if (++step_ < kSetup.size()) return;
  stage_ = Stage::running;
  tick_.phase = ServoPhase::ready;
  tick_.trouble = ServoTrouble::none;
  tick_.alarm_bits = 0;
  torque_sent_ = torque_known_ = false;
  baud_changes_ = 0;
  ticks_to_check_ = kTicksBetweenChecks;
  check_watchdog_next_ = true;
  check_error_next_ = false;
}

void Servo::take_check(Register which, std::uint32_t value) {
  if (which == kHardwareErrorStatus) {
    check_error_next_ = false;
    if (value != 0) enter_alarm(static_cast<std::uint8_t>(value));
    return;
  }
  if (stage_ != Stage::running) return;
  if (which == kTorqueCheck) {
    // The write was lost, or the servo switched its torque off by itself.
    if (((value & 1U) != 0) != torque_sent_) torque_known_ = false;
    return;
  }
  if (which != kBusWatchdog || value == watchdog_units(settings_)) return;
  // Tripped: the servo refuses goals until this is cleared. Any other value: the servo has lost power meanwhile.
  if (value == kWatchdogTripped) ++counts_.watchdog_trips;
  begin_setup();
}

void Servo::expire(std::int64_t now_ns) {
  if (request_.kind == RequestKind::nothing || now_ns < request_.deadline_ns) return;
  request_.kind = RequestKind::nothing;
  ++counts_.timeouts;
  ++unanswered_requests_;
  check_watchdog_next_ = true;
  typical_answer_ns_ = std::min(2 * typical_answer_ns_, kMaxAdapterDelayNs);
  if (stage_ == Stage::searching || stage_ == Stage::changing_baud) return;
  // Wait, so that a late answer isn't taken for the answer to another request.
  if (stage_ == Stage::setting_up) line_free_ns_ = std::max(line_free_ns_, now_ns + kMaxAdapterDelayNs);
  if (unanswered_requests_ >= kMaxUnansweredRequests) begin_search();
}

// --- sending requests ---

void Servo::flush(std::int64_t now_ns) {
  if (out_size_ == 0) return;
  const port::PortCount count = port_.write(std::span(out_).first(out_size_));
  if (count.status == port::PortStatus::gone) tick_.status = count.status;
  out_size_ = 0;
  last_sent_ns_ = now_ns;
}

void Servo::send_request(RequestKind kind, Register which, std::size_t request_bytes, std::size_t answer_data, std::int64_t now_ns) {
  add(request_bytes);
  request_.kind = kind;
  request_.which = which;
  request_.sent_ns = now_ns;
  request_.transmitted_ns = now_ns + line_ns(out_size_);
  request_.answer_bytes = kStatusFrame + answer_data;
  const std::int64_t exchange = line_ns(out_size_ + request_.answer_bytes) + kTurnAroundNs;
  line_free_ns_ = now_ns + exchange;
  request_.deadline_ns = now_ns + exchange + std::min(kMaxAdapterDelayNs, std::max<std::int64_t>(2 * typical_answer_ns_, 5'000'000));
}

/// Writes a register during set-up. Whether the servo answers depends on its previous settings, so wait for the time of an answer.
void Servo::write_and_wait(Register which, std::uint32_t value, std::int64_t now_ns) {
  add(encode_write(settings_.id, which.address, value, which.size, free_output()));
  line_free_ns_ = now_ns + line_ns(out_size_ + kStatusFrame) + kTurnAroundNs;
}

void Servo::begin_search() {
  stage_ = Stage::searching;
  tick_.phase = ServoPhase::absent;
  candidate_ = 0;
  pings_left_ = 0;
}

/// Tries the candidate baud rates; every second attempt uses the expected one, at which the servo was found last or should be.
void Servo::next_candidate(std::int64_t now_ns) {
  const std::size_t all = 2 * kCandidateBauds.size();
  const int expected = found_baud_ != 0 ? found_baud_ : settings_.baud;
  const int baud = candidate_ % 2 == 0 ? expected : kCandidateBauds[candidate_ / 2];
  if (++candidate_ == all) {
    candidate_ = 0;
    found_baud_ = 0;
    tick_.trouble = ServoTrouble::no_answer;
  }
  if (baud != line_baud_ && !port_.set_baud(baud)) return;
  line_baud_ = baud;
  parser_.reset();
  pings_left_ = kPingsPerBaud;
  // Changing an adapter's baud rate takes one millisecond of USB time, so do it less often when no servo has answered at any rate.
  line_free_ns_ = tick_.trouble == ServoTrouble::no_answer ? now_ns + kSearchPauseNs : now_ns;
}

void Servo::search(std::int64_t now_ns) {
  if (request_.kind != RequestKind::nothing) return;
  if (pings_left_ == 0) next_candidate(now_ns);
  if (pings_left_ == 0 || now_ns < line_free_ns_) return;
  --pings_left_;
  typical_answer_ns_ = kMaxAdapterDelayNs;
  send_request(RequestKind::ping, {}, encode_ping(settings_.id, free_output()), kPingAnswerData, now_ns);
}

void Servo::begin_setup() {
  stage_ = Stage::setting_up;
  tick_.phase = ServoPhase::setting_up;
  step_ = 0;
  write_attempts_ = 0;
  // The first register makes the servo answer, so write it before reading it.
  write_next_ = true;
}

std::uint32_t Servo::required_value(Register which) const {
  const auto end = [&](double mm) { return static_cast<std::uint32_t>(ticks_from_mm(settings_, mm)); };
  const double right = settings_.reversed ? -settings_.travel_mm : settings_.travel_mm;
  if (which == kStatusReturnLevel) return kAnswerReads;
  if (which == kBaudRate) return static_cast<std::uint32_t>(baud_code(settings_.baud));
  if (which == kOperatingMode) return kPositionMode;
  if (which == kMaxPositionLimit) return end(right);
  if (which == kMinPositionLimit) return end(-right);
  if (which == kProfileVelocity) return velocity_units(settings_, settings_.speed_mm_s);
  if (which == kBusWatchdog) return step_ + 1 == kSetup.size() ? watchdog_units(settings_) : 0;
  return 0;
}

void Servo::set_up(std::int64_t now_ns) {
  if (request_.kind != RequestKind::nothing) return;
  const Register which = kSetup[step_];
  if (std::exchange(write_next_, false)) {
    write_and_wait(which, required_value(which), now_ns);
    if (which == kBaudRate) stage_ = Stage::changing_baud;
    return;
  }
  request_value(which, now_ns);
}

/// The new baud rate has been written and transmitted: switch the port to it, and search the servo again.
void Servo::change_baud(std::int64_t now_ns) {
  if (++baud_changes_ > kMaxWriteAttempts || !port_.set_baud(settings_.baud)) {
    baud_changes_ = 0;
    return refuse(ServoTrouble::refused, kBaudRate.address, now_ns);
  }
  line_baud_ = found_baud_ = settings_.baud;
  parser_.reset();
  begin_search();
}

void Servo::run(std::int64_t now_ns, double goal_mm, bool powered) {
  if (now_ns - last_sent_ns_ > settings_.watchdog_ns) check_watchdog_next_ = true;
  if (!torque_known_ || torque_sent_ != powered) {
    add(encode_write(settings_.id, kTorqueEnable.address, powered ? 1 : 0, kTorqueEnable.size, free_output()));
    torque_sent_ = powered;
    torque_known_ = true;
  } else if (powered && std::isfinite(goal_mm)) {
    const auto ticks = static_cast<std::uint32_t>(ticks_from_mm(settings_, goal_mm));
    add(encode_write(settings_.id, kGoalPosition.address, ticks, kGoalPosition.size, free_output()));
  }
  if (request_.kind == RequestKind::nothing)
    request_motion_or_check(now_ns);
  else
    line_free_ns_ = now_ns + line_ns(out_size_);
}

void Servo::request_motion_or_check(std::int64_t now_ns) {
  if (check_error_next_) return request_value(kHardwareErrorStatus, now_ns);
  if (--ticks_to_check_ > 0 && !check_watchdog_next_) return request_motion(now_ns);
  torque_is_next_ = !torque_is_next_ && !check_watchdog_next_;
  ticks_to_check_ = kTicksBetweenChecks;
  check_watchdog_next_ = false;
  request_value(torque_is_next_ ? kTorqueCheck : kBusWatchdog, now_ns);
}

void Servo::request_motion(std::int64_t now_ns) {
  send_request(RequestKind::motion, kPresentVelocity, encode_read(settings_.id, kPresentVelocity.address, kMotionData, free_output()),
               kMotionData, now_ns);
}

void Servo::request_value(Register which, std::int64_t now_ns) {
  send_request(RequestKind::value, which, encode_read(settings_.id, which.address, which.size, free_output()), which.size, now_ns);
}

void Servo::enter_alarm(std::uint8_t bits) {
  if (stage_ != Stage::alarm) {
    torque_off_since_alarm_ = false;
    ticks_to_check_ = kTicksBetweenChecks;
  }
  stage_ = Stage::alarm;
  tick_.phase = ServoPhase::alarm;
  tick_.alarm_bits = bits;
}

/// After an alarm only a reboot enables torque again; until then, keep reading the position.
void Servo::watch_alarm(std::int64_t now_ns, bool powered) {
  if (!powered) torque_off_since_alarm_ = true;
  if (powered && torque_off_since_alarm_) {
    add(encode_reboot(settings_.id, free_output()));
    request_.kind = RequestKind::nothing;
    stage_ = Stage::rebooting;
    tick_.phase = ServoPhase::absent;
    tick_.alarm_bits = 0;
    line_free_ns_ = now_ns + kRebootNs;
    return;
  }
  if (request_.kind != RequestKind::nothing) return;
  if (--ticks_to_check_ > 0) return request_motion(now_ns);
  // Check for additional faults.
  ticks_to_check_ = kTicksBetweenChecks;
  request_value(kHardwareErrorStatus, now_ns);
}

std::string trouble_text(const PrismServo::Tick& tick, const settings::PrismServoSettings& settings) {
  const std::string number = std::to_string(tick.trouble_number);
  if (tick.phase == ServoPhase::alarm) {
    std::string bits;
    for (unsigned bit = 0; bit < 8; ++bit)
      if ((tick.alarm_bits >> bit & 1U) != 0) bits.append(bits.empty() ? "" : ", ").append(hardware_error_name(bit));
    return "the prism servo has switched its motor off (" + bits + "): look for what blocks or heats it, and at its supply";
  }
  switch (tick.trouble) {
    case ServoTrouble::none: return {};
    case ServoTrouble::no_answer:
      return "no servo with id " + std::to_string(settings.id) + " answers on " + settings.port +
             " at any speed: look at its supply, its cable and prism_servo.id";
    case ServoTrouble::other_model:
      return "the servo on " + settings.port + " says it is model " + number +
             ", whose registers aren't known here: it has to be a Dynamixel of the X series, or MX with firmware 2.0";
    case ServoTrouble::refused:
      return "the prism servo doesn't take what its register " + number + " has to be set to: restore its factory settings and try again";
    case ServoTrouble::too_slow:
      return "the prism servo's velocity limit (register " + number +
             ") is below prism_servo.speed_mm_s: raise the limit or lower the speed";
  }
  return {};
}

void Servo::refuse(ServoTrouble why, std::uint16_t number, std::int64_t now_ns) {
  stage_ = Stage::refused;
  tick_.phase = ServoPhase::absent;
  tick_.trouble = why;
  tick_.trouble_number = number;
  line_free_ns_ = now_ns + kRetryPauseNs;
}

}  // namespace prismesh::drivers::prism_servo::dynamixel
