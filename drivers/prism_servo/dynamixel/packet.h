// Dynamixel Protocol 2.0: bytes to packets and back. Pure, of fixed size, nothing is allocated.
//
// A packet is FF FF FD 00 | id | length (2) | instruction | parameters | CRC-16 (2), numbers low byte first. `length` counts what follows
// it, stuffing included. Where FF FF FD comes up from the instruction to the last parameter, another FD is put behind it, so that a
// header can't be mistaken; length and CRC are those of the stuffed packet. A status packet is an instruction 0x55 whose first
// parameter is the error byte: bit 7 says that the servo's hardware error register isn't zero (alert), the rest is a number.
//
// Source: ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0" (emanual.robotis.com/docs/en/dxl/protocol2) and "CRC Calculation".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace prismesh::drivers::prism_servo::dynamixel {

enum class Instruction : std::uint8_t {
  ping = 0x01,
  read = 0x02,
  write = 0x03,
  reboot = 0x08,
  status = 0x55,
  sync_read = 0x82,
  sync_write = 0x83,
};

/// What a servo says of an instruction that it didn't carry out.
enum class Refusal : std::uint8_t {
  none = 0,
  failed = 1,
  unknown_instruction = 2,
  crc = 3,
  range = 4,   ///< also: a goal while the bus watchdog has tripped
  length = 5,  ///< a register written in part
  limit = 6,   ///< outside another register's limit
  access = 7,  ///< read only, not there, or EEPROM while torque is on
};

inline constexpr std::uint8_t kBroadcastId = 0xFE;
inline constexpr std::uint8_t kLastId = 252;
inline constexpr std::uint8_t kAlertBit = 0x80;
/// No packet of this dialogue is longer; a length field that says more is noise.
inline constexpr std::size_t kMaxPacketLength = 128;
inline constexpr std::size_t kMaxParameters = 80;
/// Bytes around the parameters: header, id, length, instruction, CRC.
inline constexpr std::size_t kPacketFrame = 10;

struct Packet {
  std::uint8_t id = 0;
  Instruction instruction = Instruction::ping;
  std::uint8_t error = 0;  ///< of a status: Refusal, without the alert bit
  bool alert = false;      ///< of a status
  std::uint8_t count = 0;  ///< of parameters, the error byte of a status not among them
  std::array<std::uint8_t, kMaxParameters> parameters{};

  std::span<const std::uint8_t> data() const { return {parameters.data(), count}; }
};

/// CRC-16, polynomial 0x8005, most significant bit first. `from`: of the bytes before.
std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t from = 0);

/// An instruction's bytes, stuffed. Returns their number, 0 if they don't fit into `to` or are longer than kMaxPacketLength.
std::size_t encode(std::uint8_t id, Instruction instruction, std::span<const std::uint8_t> parameters, std::span<std::byte> to);
/// A servo's answer. `error` with its alert bit.
std::size_t encode_status(std::uint8_t id, std::uint8_t error, std::span<const std::uint8_t> parameters, std::span<std::byte> to);

std::size_t encode_ping(std::uint8_t id, std::span<std::byte> to);
std::size_t encode_reboot(std::uint8_t id, std::span<std::byte> to);
std::size_t encode_read(std::uint8_t id, std::uint16_t address, std::uint16_t length, std::span<std::byte> to);
/// `size` (1, 2 or 4) low bytes of `value`, low byte first.
std::size_t encode_write(std::uint8_t id, std::uint16_t address, std::uint32_t value, std::size_t size, std::span<std::byte> to);

/// A number of 1, 2 or 4 bytes at a place of a packet's data; 0 where the data end earlier.
std::uint32_t number_at(std::span<const std::uint8_t> data, std::size_t at, std::size_t size);

/// Finds the packets in a stream that may begin anywhere and hold anything. Give it bytes, then call `next` until it has no more.
class Parser {
 public:
  /// Takes bytes in and returns how many: all of them if `next` has been called until it returned nullptr and there are no more than
  /// kMaxPacketLength.
  std::size_t take(std::span<const std::byte> bytes);
  /// The next whole packet whose CRC is right, instructions (an adapter's echo) as well as answers; valid until the next call.
  const Packet* next();
  /// Forgets a packet that has begun.
  void reset() { size_ = 0; }

  std::uint64_t bad_packets() const { return bad_packets_; }      ///< a header was there, but length, CRC or stuffing weren't right
  std::uint64_t bytes_skipped() const { return bytes_skipped_; }  ///< that belong to no packet

 private:
  enum class Found : std::uint8_t { nothing, more_is_needed, packet, noise };
  Found look();
  bool unpack(std::size_t end);
  std::size_t next_header(std::size_t from, std::size_t end) const;
  void drop(std::size_t bytes);

  std::array<std::uint8_t, 2 * kMaxPacketLength> buffer_{};
  std::size_t size_ = 0;
  Packet packet_;
  std::uint64_t bad_packets_ = 0, bytes_skipped_ = 0;
};

}  // namespace prismesh::drivers::prism_servo::dynamixel
