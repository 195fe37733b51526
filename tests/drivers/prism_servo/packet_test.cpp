#include "drivers/prism_servo/dynamixel/packet.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::drivers::prism_servo::dynamixel {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

using Bytes = std::vector<std::uint8_t>;

template <class Encode>
Bytes encoded(Encode encode_into) {
  std::array<std::byte, kMaxPacketLength> buffer{};
  const std::size_t count = encode_into(std::span(buffer));
  Bytes bytes;
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(std::to_integer<std::uint8_t>(buffer[i]));
  return bytes;
}

struct Seen {
  std::uint8_t id;
  Instruction instruction;
  std::uint8_t error;
  bool alert;
  Bytes data;
  bool operator==(const Seen&) const = default;
};

/// Returns all packets that a parser finds, with the bytes given in pieces of `piece` bytes.
std::vector<Seen> parsed(const Bytes& bytes, std::size_t piece = 16, Parser* parser = nullptr) {
  Parser own;
  Parser& used = parser != nullptr ? *parser : own;
  std::vector<Seen> seen;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const std::size_t count = std::min(piece, bytes.size() - at);
    EXPECT_EQ(used.take(std::as_bytes(std::span(bytes).subspan(at, count))), count);
    while (const Packet* packet = used.next())
      seen.push_back({packet->id, packet->instruction, packet->error, packet->alert, Bytes(packet->data().begin(), packet->data().end())});
  }
  return seen;
}

// The examples on the e-Manual's page on Protocol 2.0, byte for byte.
TEST(dynamixel_packet, encodes_the_manuals_instructions) {
  EXPECT_THAT(encoded([](auto to) { return encode_ping(1, to); }), ElementsAre(0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E));
  EXPECT_THAT(encoded([](auto to) { return encode_ping(kBroadcastId, to); }), ElementsAre(0xFF, 0xFF, 0xFD, 0, 0xFE, 3, 0, 1, 0x31, 0x42));
  EXPECT_THAT(encoded([](auto to) { return encode_reboot(1, to); }), ElementsAre(0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 8, 0x2F, 0x4E));
  EXPECT_THAT(encoded([](auto to) { return encode_read(1, 132, 4, to); }),
              ElementsAre(0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 2, 0x84, 0, 4, 0, 0x1D, 0x15));
  EXPECT_THAT(encoded([](auto to) { return encode_write(1, 116, 512, 4, to); }),
              ElementsAre(0xFF, 0xFF, 0xFD, 0, 1, 9, 0, 3, 0x74, 0, 0, 2, 0, 0, 0xCA, 0x89));
  const Bytes sync = {0x84, 0, 4, 0, 1, 2};
  EXPECT_THAT(encoded([&](auto to) { return encode(kBroadcastId, Instruction::sync_read, sync, to); }),
              ElementsAre(0xFF, 0xFF, 0xFD, 0, 0xFE, 9, 0, 0x82, 0x84, 0, 4, 0, 1, 2, 0xCE, 0xFA));
}

TEST(dynamixel_packet, decodes_the_manuals_answers) {
  const Bytes ping = {0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 0x55, 0, 6, 4, 0x26, 0x65, 0x5D};
  const Bytes position = {0xFF, 0xFF, 0xFD, 0, 1, 8, 0, 0x55, 0, 0xA6, 0, 0, 0, 0x8C, 0xC0};
  const Bytes written = {0xFF, 0xFF, 0xFD, 0, 1, 4, 0, 0x55, 0, 0xA1, 0x0C};
  EXPECT_THAT(parsed(ping), ElementsAre(Seen{1, Instruction::status, 0, false, {6, 4, 0x26}}));
  EXPECT_THAT(parsed(position), ElementsAre(Seen{1, Instruction::status, 0, false, {0xA6, 0, 0, 0}}));
  EXPECT_THAT(parsed(written), ElementsAre(Seen{1, Instruction::status, 0, false, {}}));
}

TEST(dynamixel_packet, answers_carry_error_and_alert) {
  const Bytes bytes = encoded([](auto to) { return encode_status(7, 0x87, {}, to); });
  EXPECT_THAT(parsed(bytes), ElementsAre(Seen{7, Instruction::status, 7, true, {}}));
}

TEST(dynamixel_packet, stuffs_what_looks_like_a_header) {
  const Bytes header = {0xFF, 0xFF, 0xFD, 0x00};
  const Bytes bytes = encoded([&](auto to) { return encode(3, Instruction::write, header, to); });
  EXPECT_THAT(std::span(bytes).subspan(5, 8), ElementsAre(8, 0, 3, 0xFF, 0xFF, 0xFD, 0xFD, 0x00));
  EXPECT_THAT(parsed(bytes), ElementsAre(Seen{3, Instruction::write, 0, false, header}));
}

TEST(dynamixel_packet, stuffing_is_removed_at_any_position) {
  std::mt19937 random(5);
  const Bytes alphabet = {0xFF, 0xFF, 0xFD, 0x00, 0x42};
  for (int round = 0; round < 20'000; ++round) {
    Bytes data(random() % 40);
    for (std::uint8_t& byte : data) byte = alphabet[random() % alphabet.size()];
    const auto error = static_cast<std::uint8_t>(random() % 2 == 0 ? 0xFD : 0xFF);
    const Bytes bytes = encoded([&](auto to) { return encode_status(9, error, data, to); });
    const Seen wanted{9, Instruction::status, static_cast<std::uint8_t>(error & 0x7F), true, data};
    ASSERT_THAT(parsed(bytes, 1 + random() % 20), ElementsAre(wanted));
  }
}

TEST(dynamixel_packet, fails_if_it_does_not_fit) {
  std::array<std::byte, 15> small{};
  EXPECT_EQ(encode_write(1, 116, 0, 4, small), 0U);
  EXPECT_EQ(encode_ping(1, small), 10U);
  const Bytes long_data(200, 1);
  std::array<std::byte, 400> large{};
  EXPECT_EQ(encode(1, Instruction::write, long_data, large), 0U);
}

/// A stream of answers with noise between them.
struct Stream {
  Bytes bytes;
  std::vector<Seen> packets;
  std::vector<std::size_t> starts;
};

Stream stream_of(int packets, std::mt19937& random, std::size_t max_noise) {
  Stream stream;
  for (int i = 0; i < packets; ++i) {
    const std::size_t noise = max_noise == 0 ? 0 : random() % max_noise;
    for (std::size_t n = 0; n < noise; ++n) stream.bytes.push_back(static_cast<std::uint8_t>(random()));
    Bytes data(random() % 12);
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
    stream.starts.push_back(stream.bytes.size());
    const Bytes packet = encoded([&](auto to) { return encode_status(1, 0, data, to); });
    stream.bytes.insert(stream.bytes.end(), packet.begin(), packet.end());
    stream.packets.push_back({1, Instruction::status, 0, false, data});
  }
  return stream;
}

TEST(dynamixel_parser, finds_every_packet_after_joining_at_any_byte) {
  std::mt19937 random(11);
  const Stream stream = stream_of(12, random, 0);
  for (std::size_t join = 0; join < stream.bytes.size(); ++join) {
    const auto first_whole =
        static_cast<std::size_t>(std::lower_bound(stream.starts.begin(), stream.starts.end(), join) - stream.starts.begin());
    const std::vector<Seen> wanted(stream.packets.begin() + static_cast<std::ptrdiff_t>(first_whole), stream.packets.end());
    ASSERT_THAT(parsed(Bytes(stream.bytes.begin() + static_cast<std::ptrdiff_t>(join), stream.bytes.end())), ElementsAreArray(wanted))
        << "joined at byte " << join;
  }
}

TEST(dynamixel_parser, a_lost_byte_loses_one_packet) {
  std::mt19937 random(12);
  const Stream stream = stream_of(8, random, 0);
  for (std::size_t lost = 0; lost < stream.starts[6]; ++lost) {
    Bytes bytes = stream.bytes;
    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(lost));
    const auto hit =
        static_cast<std::size_t>(std::upper_bound(stream.starts.begin(), stream.starts.end(), lost) - stream.starts.begin()) - 1;
    std::vector<Seen> wanted = stream.packets;
    wanted.erase(wanted.begin() + static_cast<std::ptrdiff_t>(hit));
    ASSERT_THAT(parsed(bytes), ElementsAreArray(wanted)) << "without byte " << lost;
  }
}

TEST(dynamixel_parser, a_flipped_bit_never_gives_a_wrong_packet) {
  std::mt19937 random(13);
  const Stream stream = stream_of(3, random, 0);
  for (std::size_t bit = 0; bit < 8 * stream.starts[2]; ++bit) {
    Bytes bytes = stream.bytes;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
    for (const Seen& seen : parsed(bytes)) ASSERT_TRUE(std::count(stream.packets.begin(), stream.packets.end(), seen) > 0) << "bit " << bit;
  }
}

TEST(dynamixel_parser, noise_between_packets_loses_none) {
  std::mt19937 random(14);
  int lost = 0, all = 0;
  for (int round = 0; round < 300; ++round) {
    const Stream stream = stream_of(20, random, 30);
    Bytes bytes = stream.bytes;
    bytes.insert(bytes.end(), kMaxPacketLength, 0);  // ends any packet that the noise seems to begin
    Parser parser;
    const std::vector<Seen> found = parsed(bytes, 1 + random() % 60, &parser);
    ASSERT_LE(found.size(), stream.packets.size());
    lost += static_cast<int>(stream.packets.size() - found.size());
    all += 20;
    EXPECT_GT(parser.bytes_skipped(), 0U);
  }
  EXPECT_EQ(lost, 0) << "of " << all;
}

TEST(dynamixel_parser, a_truncated_packet_does_not_hide_the_next) {
  Bytes bytes = {0xFF, 0xFF, 0xFD, 0, 1, 100, 0, 0x55, 0, 1, 2};
  const Bytes whole = encoded([](auto to) { return encode_status(1, 0, Bytes{7}, to); });
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  EXPECT_THAT(parsed(bytes), ElementsAre(Seen{1, Instruction::status, 0, false, {7}}));
}

TEST(dynamixel_parser, returns_an_echo_as_an_instruction) {
  Bytes line = encoded([](auto to) { return encode_read(1, 132, 4, to); });
  const Bytes answer = encoded([](auto to) { return encode_status(1, 0, Bytes{0xA6, 0, 0, 0}, to); });
  line.insert(line.end(), answer.begin(), answer.end());
  EXPECT_THAT(parsed(line),
              ElementsAre(Seen{1, Instruction::read, 0, false, {132, 0, 4, 0}}, Seen{1, Instruction::status, 0, false, {0xA6, 0, 0, 0}}));
}

TEST(dynamixel_parser, noise_alone_is_only_counted) {
  std::mt19937 random(15);
  Bytes garbage(100'000);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
  Parser parser;
  EXPECT_TRUE(parsed(garbage, 64, &parser).empty());
  EXPECT_GT(parser.bytes_skipped(), garbage.size() - kMaxPacketLength);
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo::dynamixel
