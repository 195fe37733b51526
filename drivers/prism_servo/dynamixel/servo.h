// The prism mask's motor as a Dynamixel X servo in position mode. One dialogue step a tick: found by pings (at any of the speeds a servo
// may have been left at), set up register by register (read first, written only if different: EEPROM wears out), then each tick one goal,
// which the servo doesn't answer, and one question for velocity and position, whose answer is taken at the next tick.
//
// At 1 Mbaud that is 16 bytes of goal, 14 of question, 19 of answer: 0.49 ms of line a tick.
// The zero and the travel are places of the absolute encoder, so the whole travel has to lie within one turn.
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
  int baud = 1'000'000;  ///< the servo is set to it if it speaks at another one
  double travel_mm_per_turn = 5;
  bool reversed = false;  ///< the mask goes to the right when the encoder counts down
  int zero_ticks = 2048;
  double travel_mm = 2;
  double speed_mm_s = 5;
  std::int64_t lag_ns = 15'000'000;
  std::int64_t watchdog_ns = 100'000'000;  ///< the servo stops when it hears nothing for so long; rounded up to 20 ms
};

/// Errors, with the port as their file: an id or speed that no servo has, a travel that doesn't fit into the encoder's turn, numbers that
/// aren't finite or not above zero.
Result<ServoSettings> servo_settings(const settings::PrismServoSettings& settings);

/// The encoder's place for a mask position, rounded and held within the travel. NaN: the zero.
std::int32_t ticks_from_mm(const ServoSettings& settings, double mm);
double mm_from_ticks(const ServoSettings& settings, std::int32_t ticks);
/// Profile velocity (0.229 turns a minute), at least 1.
std::uint32_t velocity_units(const ServoSettings& settings, double mm_s);

class Servo final : public PrismServo {
 public:
  /// `port` must outlive this and be open.
  Servo(port::BytePort& port, const ServoSettings& settings);

  Tick tick(std::int64_t now_ns, double goal_mm, bool powered) override;
  const Counts& counts() const override { return counts_; }
  std::int64_t lag_ns() const override { return settings_.lag_ns; }

  /// The speed at which the servo was found last, and what it said it is; 0 before.
  int found_baud() const { return found_baud_; }
  std::uint16_t model() const { return model_; }

 private:
  enum class Stage : std::uint8_t { searching, setting_up, changing_baud, running, alarm, rebooting, refused };
  enum class Asked : std::uint8_t { nothing, ping, value, motion };
  struct Question {
    Asked what = Asked::nothing;
    Register which;
    std::int64_t sent_ns = 0;
    std::int64_t gone_ns = 0;  ///< when its last byte has left, at the earliest
    std::int64_t deadline_ns = 0;
    std::size_t answer_bytes = 0;
  };

  // What comes in.
  void hear(std::int64_t now_ns);
  void take(const Packet& packet, std::int64_t now_ns);
  void take_refusal(const Question& question, std::int64_t now_ns);
  void take_ping(const Packet& packet, std::int64_t now_ns);
  void take_value(Register which, std::uint32_t value, std::int64_t now_ns);
  void take_setup_value(std::uint32_t value, std::int64_t now_ns);
  void take_check(Register which, std::uint32_t value);
  void take_motion(const Packet& packet, const Question& question, std::int64_t now_ns);
  void expire(std::int64_t now_ns);

  // What goes out, by stage.
  void search(std::int64_t now_ns);
  void next_candidate(std::int64_t now_ns);
  void set_up(std::int64_t now_ns);
  void change_baud(std::int64_t now_ns);
  void run(std::int64_t now_ns, double goal_mm, bool powered);
  void ask_motion_or_check(std::int64_t now_ns);
  void ask_motion(std::int64_t now_ns);
  void ask_value(Register which, std::int64_t now_ns);
  void watch_alarm(std::int64_t now_ns, bool powered);

  void begin_search();
  void begin_setup();
  void refuse(ServoTrouble why, std::uint16_t number, std::int64_t now_ns);
  void give_alarm(std::uint8_t bits);
  std::uint32_t wanted(Register which) const;

  /// Puts packets together for one write to the port.
  std::span<std::byte> room() { return std::span(out_).subspan(out_size_); }
  void add(std::size_t bytes) { out_size_ += bytes; }
  void flush(std::int64_t now_ns);
  void ask(Asked what, Register which, std::size_t question_bytes, std::size_t answer_data, std::int64_t now_ns);
  void write_and_wait(Register which, std::uint32_t value, std::int64_t now_ns);
  std::int64_t line_ns(std::size_t bytes) const;

  port::BytePort& port_;
  ServoSettings settings_;
  Parser parser_;
  Tick tick_;
  PrismServo::Counts counts_;
  Stage stage_ = Stage::searching;
  Question question_;
  std::array<std::byte, 2 * kMaxPacketLength> out_{};
  std::size_t out_size_ = 0;
  std::int64_t line_free_ns_ = 0;  ///< nothing is sent before: the line is ours and the servo's in turn
  std::int64_t last_sent_ns_ = 0;
  std::int64_t usual_answer_ns_ = 0;  ///< how long answers take, as seen from here
  int line_baud_ = 0;

  std::size_t candidate_ = 0;
  int pings_left_ = 0;
  int baud_changes_ = 0;
  int found_baud_ = 0;
  std::uint16_t model_ = 0;

  std::size_t step_ = 0;
  bool write_next_ = false;  ///< else the register is asked for
  int tries_ = 0;

  int silent_questions_ = 0;
  int ticks_to_check_ = 0;
  bool check_watchdog_next_ = true, check_error_next_ = false, torque_is_next_ = false;
  bool torque_sent_ = false, torque_known_ = false;
  bool let_go_since_alarm_ = false;
};

/// What is wrong with the servo and what to do about it, in a sentence; empty when all is well. Not for a tick.
std::string trouble_text(const PrismServo::Tick& tick, const settings::PrismServoSettings& settings);

}  // namespace prismesh::drivers::prism_servo::dynamixel
