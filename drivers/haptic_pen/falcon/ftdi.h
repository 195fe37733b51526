// The requests of the FTDI chip in a Falcon, between USB and the serial line of its processor. The values are those that libnifalcon
// (FalconCommLibUSB.cpp, BSD) sends.
#pragma once

#include <cstddef>
#include <cstdint>

namespace prismesh::drivers::haptic_pen::falcon::ftdi {

inline constexpr std::uint8_t kToDevice = 0x40;
inline constexpr std::uint8_t kReset = 0, kModem = 1, kSetFlow = 2, kSetBaud = 3, kSetData = 4, kSetLatency = 9;
inline constexpr std::uint16_t kPurgeReceived = 1, kPurgeToSend = 2;
inline constexpr std::uint16_t kDtrLow = 0x0100, kDtrHigh = 0x0101, kRtsLow = 0x0200;
inline constexpr std::uint16_t kEightNoneOne = 8;
inline constexpr std::uint16_t kBaud9600 = 0x4138, kBaudLoader = 0x15, kBaudRunning = 2;  ///< 9,600, 140,000, 1,500,000
/// Each packet from the chip begins with the state of modem and line.
inline constexpr std::size_t kStatusBytes = 2;

}  // namespace prismesh::drivers::haptic_pen::falcon::ftdi
