// Codec for Dynamixel Protocol 2.0: bytes to packets and back. Fixed size, no allocation.
//
// A packet is FF FF FD 00 | id | length (2) | instruction | parameters | CRC-16 (2), with numbers in little-endian order. `length` counts
// the bytes that follow it, stuffing included. If FF FF FD occurs between the instruction and the last parameter, another FD is inserted
// after it (byte stuffing), so that it isn't taken for a header; length and CRC refer to the stuffed packet. A status packet is an
// instruction 0x55 whose first parameter is the error byte: bit 7 (alert) is set if the servo's hardware error register isn't zero, the
// other bits are an error number.
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

/// Error numbers of a status packet: why the servo didn't execute an instruction.
enum class Refusal : std::uint8_t {
  none = 0,
  failed = 1,
  unknown_instruction = 2,
  crc = 3,
  range = 4,   ///< also: a goal after the bus watchdog has tripped
  length = 5,  ///< only a part of a register is written
  limit = 6,   ///< beyond the limit in another register
  access = 7,  ///< read only, missing, or EEPROM while torque is on
};

inline constexpr std::uint8_t kBroadcastId = 0xFE;
inline constexpr std::uint8_t kMaxId = 252;
inline constexpr std::uint8_t kAlertBit = 0x80;
/// Max. length of this dialogue's packets; a larger length field is noise.
inline constexpr std::size_t kMaxPacketLength = 128;
inline constexpr std::size_t kMaxParameters = 80;
/// Bytes around the parameters: header, id, length, instruction, CRC.
inline constexpr std::size_t kPacketFrame = 10;

struct Packet {
  std::uint8_t id = 0;
  Instruction instruction = Instruction::ping;
  std::uint8_t error = 0;  ///< of a status packet: Refusal, without the alert bit
  bool alert = false;      ///< of a status packet
  std::uint8_t count = 0;  ///< number of parameters, without a status packet's error byte
  std::array<std::uint8_t, kMaxParameters> parameters{};

  std::span<const std::uint8_t> data() const { return {parameters.data(), count}; }
};

/// Returns the CRC-16 with polynomial 0x8005, most significant bit first. `from`: CRC of the preceding bytes.
std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t from = 0);

/// Writes an instruction packet, with stuffing. Returns its length in bytes; 0 if it doesn't fit into `to` or is longer than
/// kMaxPacketLength.
std::size_t encode(std::uint8_t id, Instruction instruction, std::span<const std::uint8_t> parameters, std::span<std::byte> to);
/// Writes a status packet. `error` includes the alert bit. Returns the same as `encode`.
std::size_t encode_status(std::uint8_t id, std::uint8_t error, std::span<const std::uint8_t> parameters, std::span<std::byte> to);

std::size_t encode_ping(std::uint8_t id, std::span<std::byte> to);
std::size_t encode_reboot(std::uint8_t id, std::span<std::byte> to);
std::size_t encode_read(std::uint8_t id, std::uint16_t address, std::uint16_t length, std::span<std::byte> to);
/// Writes the `size` (1, 2 or 4) low bytes of `value`, in little-endian order.
std::size_t encode_write(std::uint8_t id, std::uint16_t address, std::uint32_t value, std::size_t size, std::span<std::byte> to);

/// Returns the number of 1, 2 or 4 bytes at a position of a packet's data; 0 beyond the end of the data.
std::uint32_t number_at(std::span<const std::uint8_t> data, std::size_t at, std::size_t size);

/// Finds the packets in a byte stream that may begin at any byte and contain noise. Pass bytes to `take`, then call `next` until it returns
/// nullptr.
class Parser {
 public:
  /// Takes bytes and returns how many. Takes all of them if there are max. kMaxPacketLength and `next` has returned nullptr before.
  std::size_t take(std::span<const std::byte> bytes);
  /// Returns the next complete packet with a correct CRC, both instructions (an adapter's echo) and status packets; valid until the next
  /// call.
  const Packet* next();
  /// Discards a partial packet.
  void reset() { size_ = 0; }

  std::uint64_t bad_packets() const { return bad_packets_; }      ///< headers with a wrong length, CRC or stuffing
  std::uint64_t bytes_skipped() const { return bytes_skipped_; }  ///< bytes outside packets

 private:
  enum class ParseResult : std::uint8_t { nothing, more_is_needed, packet, noise };
  ParseResult parse();
  bool unpack(std::size_t end);
  std::size_t next_header(std::size_t from, std::size_t end) const;
  void drop(std::size_t bytes);

  std::array<std::uint8_t, 2 * kMaxPacketLength> buffer_{};
  std::size_t size_ = 0;
  Packet packet_;
  std::uint64_t bad_packets_ = 0, bytes_skipped_ = 0;
};

}  // namespace prismesh::drivers::prism_servo::dynamixel
