#include "drivers/prism_servo/dynamixel/packet.h"

#include <algorithm>
#include <cstring>

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

constexpr std::array<std::uint8_t, 4> kHeader = {0xFF, 0xFF, 0xFD, 0x00};
constexpr std::size_t kIdAt = 4;
constexpr std::size_t kLengthAt = 5;
constexpr std::size_t kInstructionAt = 7;
constexpr std::size_t kCrcSize = 2;

constexpr std::array<std::uint16_t, 256> crc_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    unsigned value = static_cast<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) value = (value & 0x8000U) != 0 ? (value << 1) ^ 0x8005U : value << 1;
    table[byte] = static_cast<std::uint16_t>(value);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> kCrcTable = crc_table();

constexpr std::uint8_t low(unsigned value) { return static_cast<std::uint8_t>(value & 0xFFU); }

/// Writes a packet from front to back, with byte stuffing.
class Writer {
 public:
  explicit Writer(std::span<std::byte> to) : to_(to.first(std::min(to.size(), kMaxPacketLength))) {}

  void plain(std::uint8_t byte) {
    if (size_ < to_.size()) to_[size_] = static_cast<std::byte>(byte);
    ++size_;
  }
  void stuffed(std::uint8_t byte) {
    plain(byte);
    last_three_ = ((last_three_ << 8) | byte) & 0xFFFFFFU;
    if (last_three_ != 0xFFFFFDU) return;
    plain(0xFD);
    last_three_ = 0;
  }
  std::size_t finish() {
    if (size_ + kCrcSize > to_.size()) return 0;
    const std::size_t length = size_ + kCrcSize - kInstructionAt;
    to_[kLengthAt] = static_cast<std::byte>(low(static_cast<unsigned>(length)));
    to_[kLengthAt + 1] = static_cast<std::byte>(low(static_cast<unsigned>(length >> 8)));
    const std::uint16_t crc = crc16({reinterpret_cast<const std::uint8_t*>(to_.data()), size_});
    plain(low(crc));
    plain(low(crc >> 8U));
    return size_;
  }

 private:
  std::span<std::byte> to_;
  std::size_t size_ = 0;
  std::uint32_t last_three_ = 0;
};

Writer begin(std::uint8_t id, Instruction instruction, std::span<std::byte> to) {
  Writer writer(to);
  for (const std::uint8_t byte : kHeader) writer.plain(byte);
  writer.plain(id);
  writer.plain(0);
  writer.plain(0);
  writer.stuffed(static_cast<std::uint8_t>(instruction));
  return writer;
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t from) {
  unsigned crc = from;
  for (const std::uint8_t byte : bytes) crc = ((crc << 8) & 0xFFFFU) ^ kCrcTable[(crc >> 8) ^ byte];
  return static_cast<std::uint16_t>(crc);
}

std::size_t encode(std::uint8_t id, Instruction instruction, std::span<const std::uint8_t> parameters, std::span<std::byte> to) {
  Writer writer = begin(id, instruction, to);
  for (const std::uint8_t byte : parameters) writer.stuffed(byte);
  return writer.finish();
}

std::size_t encode_status(std::uint8_t id, std::uint8_t error, std::span<const std::uint8_t> parameters, std::span<std::byte> to) {
  Writer writer = begin(id, Instruction::status, to);
  writer.stuffed(error);
  for (const std::uint8_t byte : parameters) writer.stuffed(byte);
  return writer.finish();
}

std::size_t encode_ping(std::uint8_t id, std::span<std::byte> to) { return encode(id, Instruction::ping, {}, to); }

std::size_t encode_reboot(std::uint8_t id, std::span<std::byte> to) { return encode(id, Instruction::reboot, {}, to); }

std::size_t encode_read(std::uint8_t id, std::uint16_t address, std::uint16_t length, std::span<std::byte> to) {
  const std::array<std::uint8_t, 4> parameters = {low(address), low(address >> 8U), low(length), low(length >> 8U)};
  return encode(id, Instruction::read, parameters, to);
}

std::size_t encode_write(std::uint8_t id, std::uint16_t address, std::uint32_t value, std::size_t size, std::span<std::byte> to) {
  const std::array<std::uint8_t, 6> parameters = {low(address),     low(address >> 8U), low(value),
                                                  low(value >> 8U), low(value >> 16U),  low(value >> 24U)};
  return encode(id, Instruction::write, std::span(parameters).first(2 + std::min<std::size_t>(size, 4)), to);
}

std::uint32_t number_at(std::span<const std::uint8_t> data, std::size_t at, std::size_t size) {
  if (at + size > data.size()) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(data[at + i]) << (8 * i);
  return value;
}

std::size_t Parser::take(std::span<const std::byte> bytes) {
  const std::size_t count = std::min(bytes.size(), buffer_.size() - size_);
  if (count > 0) std::memcpy(buffer_.data() + size_, bytes.data(), count);
  size_ += count;
  return count;
}

const Packet* Parser::next() {
  while (true) {
    switch (parse()) {
      case ParseResult::packet: return &packet_;
      case ParseResult::noise: continue;
      case ParseResult::nothing:
      case ParseResult::more_is_needed: return nullptr;
    }
  }
}

/// Parses the start of the buffer and removes the bytes that it has processed.
Parser::ParseResult Parser::parse() {
  const std::size_t header = next_header(0, size_);
  bytes_skipped_ += header;
  drop(header);
  if (size_ < kInstructionAt) return size_ == 0 ? ParseResult::nothing : ParseResult::more_is_needed;
  const std::size_t length = number_at({buffer_.data(), size_}, kLengthAt, 2);
  const std::size_t total = kInstructionAt + length;
  const bool answer_is_short =
      size_ > kInstructionAt && buffer_[kInstructionAt] == static_cast<std::uint8_t>(Instruction::status) && length < 4;
  if (buffer_[kIdAt] > kBroadcastId || buffer_[kIdAt] == 0xFD || length < 3 || total > kMaxPacketLength || answer_is_short) {
    ++bad_packets_;
    ++bytes_skipped_;
    drop(1);
    return ParseResult::noise;
  }
  // Stuffing keeps headers out of complete packets, so a header before the CRC means that this packet is truncated.
  const std::size_t body_end = std::min(size_, total - kCrcSize);
  const std::size_t next_packet = next_header(kInstructionAt, body_end);
  if (next_packet + kHeader.size() <= body_end) {
    ++bad_packets_;
    bytes_skipped_ += next_packet;
    drop(next_packet);
    return ParseResult::noise;
  }
  if (size_ < total) return ParseResult::more_is_needed;
  const std::span<const std::uint8_t> whole(buffer_.data(), total);
  if (crc16(whole.first(total - kCrcSize)) != number_at(whole, total - kCrcSize, kCrcSize) || !unpack(total - kCrcSize)) {
    ++bad_packets_;
    ++bytes_skipped_;
    drop(1);
    return ParseResult::noise;
  }
  drop(total);
  return ParseResult::packet;
}

/// Removes the stuffing. Returns false for FF FF FD without its stuffed FD, or for more parameters than any packet of this dialogue has.
bool Parser::unpack(std::size_t end) {
  packet_.id = buffer_[kIdAt];
  packet_.instruction = static_cast<Instruction>(buffer_[kInstructionAt]);
  packet_.error = 0;
  packet_.alert = false;
  packet_.count = 0;
  bool error_is_next = packet_.instruction == Instruction::status;
  std::uint32_t last_three = buffer_[kInstructionAt];
  for (std::size_t i = kInstructionAt + 1; i < end; ++i) {
    const std::uint8_t byte = buffer_[i];
    if (last_three == 0xFFFFFDU) {
      if (byte != 0xFD) return false;
      last_three = 0;
      continue;
    }
    last_three = ((last_three << 8) | byte) & 0xFFFFFFU;
    if (error_is_next) {
      packet_.error = byte & static_cast<std::uint8_t>(~kAlertBit);
      packet_.alert = (byte & kAlertBit) != 0;
      error_is_next = false;
      continue;
    }
    if (packet_.count == kMaxParameters) return false;
    packet_.parameters[packet_.count++] = byte;
  }
  return last_three != 0xFFFFFDU && !error_is_next;
}

/// Returns the position of a header, or of a partial header at the end; `end` if there is none.
std::size_t Parser::next_header(std::size_t from, std::size_t end) const {
  for (std::size_t at = from; at < end; ++at) {
    const std::size_t visible = std::min(kHeader.size(), end - at);
    if (std::equal(kHeader.begin(), kHeader.begin() + static_cast<std::ptrdiff_t>(visible),
                   buffer_.begin() + static_cast<std::ptrdiff_t>(at)))
      return at;
  }
  return end;
}

void Parser::drop(std::size_t bytes) {
  if (bytes == 0) return;
  std::memmove(buffer_.data(), buffer_.data() + bytes, size_ - bytes);
  size_ -= bytes;
}

}  // namespace prismesh::drivers::prism_servo::dynamixel
