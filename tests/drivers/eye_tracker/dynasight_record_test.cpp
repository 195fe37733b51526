#include "drivers/eye_tracker/dynasight/record.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

RecordBytes bytes_of(const std::array<unsigned, kRecordBytes>& numbers) {
  RecordBytes bytes{};
  for (std::size_t i = 0; i < kRecordBytes; ++i) bytes[i] = static_cast<std::byte>(numbers[i]);
  return bytes;
}

struct Row {
  std::array<unsigned, kRecordBytes> bytes;
  Status status;
  int target;
  int exponent;
  std::array<std::int32_t, 3> units;  ///< in units of 0.05 mm, after shifting
};

// Computed by hand from the bit layout. The first four are the same coordinates sent with each exponent.
constexpr Row kRows[] = {
    {{0x80, 0x83, 0x04, 0xB0, 0xFC, 0xE0, 0x36, 0xB0}, Status::track, 0, 0, {1200, -800, 14000}},
    {{0x81, 0x83, 0x04, 0xB0, 0xFC, 0xE0, 0x36, 0xB0}, Status::track, 0, 1, {2400, -1600, 28000}},
    {{0x82, 0x83, 0x04, 0xB0, 0xFC, 0xE0, 0x36, 0xB0}, Status::track, 0, 2, {4800, -3200, 56000}},
    {{0x83, 0x83, 0x04, 0xB0, 0xFC, 0xE0, 0x36, 0xB0}, Status::track, 0, 3, {9600, -6400, 112000}},
    {{0x8C, 0x80, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, Status::search, 3, 0, {0, 0, 0}},
    {{0x80, 0x85, 0x00, 0x01, 0xFF, 0xFF, 0x7F, 0xFF}, Status::coast, 4, 0, {1, -1, 32767}},
    {{0x8D, 0x86, 0x80, 0x00, 0x00, 0x00, 0x00, 0x80}, Status::caution, 7, 1, {-65536, 0, 256}},
};

TEST(DynasightRecord, decodes_the_documented_layout) {
  for (const Row& row : kRows) {
    const auto record = decode(bytes_of(row.bytes));
    ASSERT_TRUE(record);
    EXPECT_EQ(record->status, row.status);
    EXPECT_EQ(record->target, row.target);
    EXPECT_EQ(record->exponent, row.exponent);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(record->units(axis), row.units[axis]);
      EXPECT_DOUBLE_EQ(record->position_mm()[static_cast<Eigen::Index>(axis)], row.units[axis] * 0.05);
    }
    EXPECT_EQ(encode(*record), bytes_of(row.bytes));
  }
}

TEST(DynasightRecord, ignores_the_bit_without_a_meaning) {
  auto bytes = bytes_of(kRows[0].bytes);
  const auto without = decode(bytes);
  bytes[1] |= std::byte{0x08};
  EXPECT_EQ(decode(bytes), without);
}

TEST(DynasightRecord, a_record_begins_with_two_markers) {
  for (unsigned first = 0; first < 256; ++first)
    for (unsigned second = 0; second < 256; ++second) {
      const auto bytes = bytes_of({first, second, 0, 0, 0, 0, 0, 0});
      EXPECT_EQ(decode(bytes).has_value(), first >> 4 == 8 && second >> 4 == 8);
    }
}

TEST(DynasightRecord, encodes_a_position_with_the_min_exponent_that_holds_it) {
  EXPECT_EQ(record_for({0, 0, 650}).exponent, 0);
  EXPECT_EQ(record_for({0, 0, 32767 * 0.05}).exponent, 0);
  EXPECT_EQ(record_for({0, 0, 32768 * 0.05}).exponent, 1);
  EXPECT_EQ(record_for({-3300, 0, 650}).exponent, 2);
  EXPECT_EQ(record_for({0, 9000, 650}).exponent, 3);
}

TEST(DynasightRecord, a_position_survives_to_half_a_step_of_its_exponent) {
  for (double scale = 1; scale < 13'000; scale *= 1.37) {
    const Eigen::Vector3d place(-scale, 0.61803 * scale, 0.31831 * scale);
    const Record record = record_for(place, Status::track, 5);
    const auto again = decode(encode(record));
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, record);
    EXPECT_LE((again->position_mm() - place).cwiseAbs().maxCoeff(), 0.5 * kUnitMm * (1 << record.exponent) + 1e-9);
  }
}

TEST(DynasightRecord, limits_a_position_that_is_too_far) {
  const Record record = record_for({1e9, -1e9, 20'000});
  EXPECT_EQ(record.numbers, (std::array<std::int16_t, 3>{32767, -32767, 32767}));
  EXPECT_EQ(record.exponent, kMaxExponent);
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::dynasight
