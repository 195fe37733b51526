// Drives the prism mask's motor, a Dynamixel X servo in position mode, with one dialogue step per tick. Finds the servo by pings at each
// baud rate at which it may have been left. Sets it up register by register (reads first and writes only differences, because EEPROM wears
// out). Then sends in each tick a goal, which the servo doesn't answer, and a request for velocity and position, whose answer is read in
// the next tick.
//
// At 1 Mbaud a tick transfers 16 bytes of goal, 14 of request and 19 of answer: 0.49 ms of line time. Zero and travel refer to the absolute
// encoder, so the whole travel has to be within one turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"
#include "drivers/port/byte_port.h"
#include "drivers/prism_servo/dynamixel/packet.h"
#include "drivers/prism_servo/dynamixel/registers.h"
#include "drivers/prism_servo/prism_servo.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::prism_servo::dynamixel {

struct ServoSettings {
  std::uint8_t id = 1;
  int baud = 1'000'000;  ///< the servo is set to this baud rate if it uses another one
  double travel_mm_per_turn = 5;
  bool reversed = false;  ///< the mask moves to the right when the encoder counts down
  int zero_ticks = 2048;
  double travel_mm = 2;
  double speed_mm_s = 5;
  std::int64_t lag_ns = 15'000'000;
  std::int64_t watchdog_ns = 100'000'000;  ///< the servo stops if it receives nothing for so long; rounded up to multiples of 20 ms
};

/// Converts the settings. Errors, with the port as their file: an id or baud rate that no servo supports; a travel beyond the encoder's
/// turn; numbers that aren't finite or not above zero.
Result<ServoSettings> servo_settings(const settings::PrismServoSettings& settings);

/// Returns the encoder position for a mask position, rounded and limited to the travel. NaN gives the zero.
std::int32_t ticks_from_mm(const ServoSettings& settings, double mm);
double mm_from_ticks(const ServoSettings& settings, std::int32_t ticks);
/// Returns the profile velocity in units of 0.229 turns per minute, min. 1.
std::uint32_t velocity_units(const ServoSettings& settings, double mm_s);

class Servo final : public PrismServo {
 public:
  /// `port` must be open and outlive this.
  Servo(port::BytePort& port, const ServoSettings& settings);

  Tick tick(std::int64_t now_ns, double goal_mm, bool powered) override;
  const Counts& counts() const override { return counts_; }
  std::int64_t lag_ns() const override { return settings_.lag_ns; }

  /// The baud rate at which the servo was last found, and the model that it reported; 0 before.
  int found_baud() const { return found_baud_; }
  std::uint16_t model() const { return model_; }

 private:
  enum class Stage : std::uint8_t { searching, setting_up, changing_baud, running, alarm, rebooting, refused };
  enum class RequestKind : std::uint8_t { nothing, ping, value, motion };
  struct Request {
    RequestKind kind = RequestKind::nothing;
    Register which;
    std::int64_t sent_ns = 0;
    std::int64_t transmitted_ns = 0;  ///< earliest end of its last byte's transmission
    std::int64_t deadline_ns = 0;
    std::size_t answer_bytes = 0;
  };

  // Reading answers.
  void read_answers(std::int64_t now_ns);
  void take(const Packet& packet, std::int64_t now_ns);
  void take_refusal(const Request& request, std::int64_t now_ns);
  void take_ping(const Packet& packet, std::int64_t now_ns);
  void take_value(Register which, std::uint32_t value, std::int64_t now_ns);
  void take_setup_value(std::uint32_t value, std::int64_t now_ns);
  void take_check(Register which, std::uint32_t value);
  void take_motion(const Packet& packet, const Request& request, std::int64_t now_ns);
  void expire(std::int64_t now_ns);

  // Sending requests, by stage.
  void search(std::int64_t now_ns);
  void next_candidate(std::int64_t now_ns);
  void set_up(std::int64_t now_ns);
  void change_baud(std::int64_t now_ns);
  void run(std::int64_t now_ns, double goal_mm, bool powered);
  void request_motion_or_check(std::int64_t now_ns);
  void request_motion(std::int64_t now_ns);
  void request_value(Register which, std::int64_t now_ns);
  void watch_alarm(std::int64_t now_ns, bool powered);

  void begin_search();
  void begin_setup();
  void refuse(ServoTrouble why, std::uint16_t number, std::int64_t now_ns);
  void enter_alarm(std::uint8_t bits);
  std::uint32_t required_value(Register which) const;

  /// Collect packets for one write to the port.
  std::span<std::byte> free_output() { return std::span(out_).subspan(out_size_); }
  void add(std::size_t bytes) { out_size_ += bytes; }
  void flush(std::int64_t now_ns);
  void send_request(RequestKind kind, Register which, std::size_t request_bytes, std::size_t answer_data, std::int64_t now_ns);
  void write_and_wait(Register which, std::uint32_t value, std::int64_t now_ns);
  std::int64_t line_ns(std::size_t bytes) const;

  port::BytePort& port_;
  ServoSettings settings_;
  Parser parser_;
  Tick tick_;
  PrismServo::Counts counts_;
  Stage stage_ = Stage::searching;
  Request request_;
  std::array<std::byte, 2 * kMaxPacketLength> out_{};
  std::size_t out_size_ = 0;
  std::int64_t line_free_ns_ = 0;  ///< nothing is sent before, because host and servo share the line
  std::int64_t last_sent_ns_ = 0;
  std::int64_t typical_answer_ns_ = 0;  ///< typical time from request to answer
  int line_baud_ = 0;

  std::size_t candidate_ = 0;
  int pings_left_ = 0;
  int baud_changes_ = 0;
  int found_baud_ = 0;
  std::uint16_t model_ = 0;

  std::size_t step_ = 0;
  bool write_next_ = false;  ///< write the register before reading it
  int write_attempts_ = 0;

  int unanswered_requests_ = 0;
  int ticks_to_check_ = 0;
  bool check_watchdog_next_ = true, check_error_next_ = false, torque_is_next_ = false;
  bool torque_sent_ = false, torque_known_ = false;
  bool torque_off_since_alarm_ = false;
};

/// Returns a sentence that says what is wrong with the servo and what to do about it; empty if all is well. Allocates, so not for a tick.
std::string trouble_text(const PrismServo::Tick& tick, const settings::PrismServoSettings& settings);

}  // namespace prismesh::drivers::prism_servo::dynamixel
