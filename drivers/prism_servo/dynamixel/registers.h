// The registers of the Dynamixel X series (and of MX with firmware 2.0) that the prism mask uses, and the meaning of their values. Source:
// ROBOTIS e-Manual, control tables of XM430-W210, XL430-W250, XL330-M288 (emanual.robotis.com/docs/en/dxl/x/..), which agree on all of
// these.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace prismesh::drivers::prism_servo::dynamixel {

struct Register {
  std::uint16_t address = 0;
  std::uint8_t size = 1;
  bool operator==(const Register&) const = default;
};

// EEPROM: kept without power, writable only while torque is off.
inline constexpr Register kModelNumber{0, 2};
inline constexpr Register kFirmwareVersion{6, 1};
inline constexpr Register kId{7, 1};
inline constexpr Register kBaudRate{8, 1};
inline constexpr Register kReturnDelayTime{9, 1};  ///< unit: 2 us
inline constexpr Register kDriveMode{10, 1};       ///< 0: velocity profiles, counter-clockwise is positive
inline constexpr Register kOperatingMode{11, 1};
inline constexpr Register kHomingOffset{20, 4};  ///< added to the encoder's position
inline constexpr Register kVelocityLimit{44, 4};
inline constexpr Register kMaxPositionLimit{48, 4};
inline constexpr Register kMinPositionLimit{52, 4};
inline constexpr Register kShutdown{63, 1};
inline constexpr std::uint16_t kFirstVolatileAddress = 64;
// RAM: lost without power.
inline constexpr Register kTorqueEnable{64, 1};
inline constexpr Register kStatusReturnLevel{68, 1};
inline constexpr Register kHardwareErrorStatus{70, 1};
inline constexpr Register kBusWatchdog{98, 1};  ///< unit: 20 ms; reads 0xFF after it has tripped
inline constexpr Register kProfileAcceleration{108, 4};
inline constexpr Register kProfileVelocity{112, 4};
inline constexpr Register kGoalPosition{116, 4};
inline constexpr Register kMoving{122, 1};
inline constexpr Register kPresentVelocity{128, 4};
inline constexpr Register kPresentPosition{132, 4};

inline constexpr std::uint8_t kPositionMode = 3;  ///< of kOperatingMode: absolute position within one turn
inline constexpr std::uint8_t kAnswerReads = 1;   ///< of kStatusReturnLevel: pings and reads are answered, writes aren't
inline constexpr std::uint8_t kAnswerAll = 2;     ///< of kStatusReturnLevel: every instruction is answered
inline constexpr std::uint8_t kWatchdogTripped = 0xFF;
inline constexpr double kTicksPerTurn = 4096;
inline constexpr double kTurnsPerMinutePerUnit = 0.229;  ///< unit of velocities
inline constexpr std::int64_t kWatchdogUnitNs = 20'000'000;
inline constexpr std::int64_t kReturnDelayUnitNs = 2'000;

/// Baud rates, indexed by the value of kBaudRate.
inline constexpr std::array<int, 8> kBauds = {9'600, 57'600, 115'200, 1'000'000, 2'000'000, 3'000'000, 4'000'000, 4'500'000};
/// Returns the value of kBaudRate for a baud rate; -1 if the servo doesn't support it.
constexpr int baud_code(int baud) {
  for (std::size_t i = 0; i < kBauds.size(); ++i)
    if (kBauds[i] == baud) return static_cast<int>(i);
  return -1;
}

/// A model whose control table is the one above.
struct Model {
  std::uint16_t number = 0;
  std::string_view name;
};
std::span<const Model> known_models();
/// Returns the model's name; empty for an unknown number.
std::string_view model_name(std::uint16_t number);

/// Returns the meaning of a bit of kHardwareErrorStatus, for example "overload"; bits 0 to 5 are known.
std::string_view hardware_error_name(unsigned bit);

}  // namespace prismesh::drivers::prism_servo::dynamixel
