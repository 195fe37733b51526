// Simulates a Dynamixel X servo with a mask on its shaft, at byte level: registers with factory defaults, EEPROM locked while torque is on,
// baud rate, return delay, status level, bus watchdog, and a motor with limited speed, lag, backlash and stops. Runs in virtual time on a
// MemoryLine, or in real time in a SimulatedServoThread. Source of the behaviour: ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0" and the
// control table of XM430-W210. The code marks what the manual leaves open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/port/byte_port.h"
#include "drivers/prism_servo/dynamixel/packet.h"
#include "drivers/prism_servo/dynamixel/registers.h"

namespace prismesh::drivers::prism_servo::dynamixel {

struct SimulatedServoSettings {
  std::uint16_t model = 1030;  ///< XM430-W210
  std::uint8_t id = 1;
  int baud = 57'600;  ///< factory default
  std::uint8_t return_delay = 250;
  double travel_mm_per_turn = 5;  ///< mounting of the mask on the shaft; the three values as in PrismServoSettings
  bool reversed = false;
  int zero_ticks = 2048;
  double start_mm = 0.6;                           ///< initial mask position
  double stop_mm = 2.3;                            ///< position of the mechanical stop on either side
  double speed_mm_s = 6;                           ///< max. speed of the motor
  double lag_ms = 15;                              ///< time constant with which the motor follows its profile
  double backlash_mm = 0.01;                       ///< between motor and mask; the encoder is on the motor
  double overload_mm = 0.1;                        ///< a motor that stays so far behind its profile
  std::int64_t overload_after_ns = 1'500'000'000;  ///< for so long switches itself off
  std::int64_t boot_ns = 300'000'000;              ///< no answers for so long after power-on or a reboot
  bool echoes = false;                             ///< the adapter returns the host's own bytes
};

class SimulatedServo {
 public:
  /// `port` is the device's end and must outlive this. Sets its baud rate from the registers.
  SimulatedServo(port::BytePort& port, const SimulatedServoSettings& settings);

  /// Advances to `now_ns`: executes received instructions, sends due answers, moves the motor. Call it in steps of max. one millisecond.
  void step(std::int64_t now_ns);

  // Faults.
  void jam(bool jammed) { jammed_ = jammed; }    ///< blocks the mask
  void set_power(bool on);                       ///< off: no answers, no torque, volatile registers reset
  void raise_hardware_error(std::uint8_t bits);  ///< bits of kHardwareErrorStatus
  void mute(bool muted) { muted_ = muted; }      ///< receives and moves, but doesn't answer: a broken wire

  double mask_mm() const { return mask_mm_; }  ///< true position of the mask
  double motor_mm() const { return motor_mm_; }
  double motor_velocity_mm_s() const { return velocity_mm_s_; }
  bool torque() const { return powered_ && value(kTorqueEnable) != 0; }
  bool watchdog_tripped() const { return value(kBusWatchdog) == kWatchdogTripped; }
  std::uint32_t value(Register which) const;
  void set_value(Register which, std::uint32_t value);  ///< sets an initial state, without checks

  struct Counts {
    std::uint64_t instructions = 0, answers = 0, bad_packets = 0, refused = 0, goals = 0, eeprom_writes = 0, watchdog_trips = 0;
    std::uint64_t goals_beyond_limits = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Answer {
    std::int64_t due_ns = 0;
    std::size_t size = 0;
    std::array<std::byte, kMaxPacketLength> bytes{};
  };
  void factory_registers();
  void reset_volatile();
  void boot(std::int64_t now_ns);
  void read_instructions(std::int64_t now_ns);
  void execute(const Packet& packet, std::int64_t now_ns);
  void ping(std::int64_t now_ns);
  void read(const Packet& packet, std::int64_t now_ns);
  void write(const Packet& packet, std::int64_t now_ns);
  Refusal write_register(Register which, std::uint32_t value);
  Refusal check(Register which, std::uint32_t value) const;
  void answer(std::int64_t now_ns, Refusal refusal, std::span<const std::uint8_t> data);
  void send_due(std::int64_t now_ns);
  void check_watchdog(std::int64_t now_ns);
  void simulate_motor(std::int64_t now_ns);
  void move_motor(double seconds);
  void move_mask();
  void check_load(std::int64_t now_ns);
  void update_motion_registers();
  double ticks_from(double mm) const;
  double mm_from(double ticks) const;
  double speed_limit_mm_s() const;

  port::BytePort& port_;
  SimulatedServoSettings settings_;
  std::array<std::uint8_t, 256> table_{};
  Parser parser_;
  std::array<Answer, 8> answers_{};
  std::size_t answers_waiting_ = 0;
  Counts counts_;
  bool powered_ = true, jammed_ = false, muted_ = false, started_ = false;
  std::int64_t now_ns_ = 0, boot_until_ns_ = 0, last_instruction_ns_ = 0, overload_since_ns_ = 0;
  bool rebooting_ = false;
  int baud_after_answer_ = 0;
  double profile_mm_ = 0, motor_mm_ = 0, mask_mm_ = 0, velocity_mm_s_ = 0;
};

}  // namespace prismesh::drivers::prism_servo::dynamixel
