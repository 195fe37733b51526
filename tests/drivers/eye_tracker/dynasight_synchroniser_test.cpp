// The stream is joined at any byte, damaged at any byte, and contains numbers that look like headers. No record may be reported that wasn't
// sent.
#include "drivers/eye_tracker/dynasight/synchroniser.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

using Random = std::mt19937_64;

int integer(Random& random, int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); }
double real(Random& random, double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }

/// The records that a device sends.
struct Sent {
  std::vector<std::byte> bytes;
  std::vector<Record> records;
  void add(const Record& record) {
    records.push_back(record);
    const RecordBytes made = encode(record);
    bytes.insert(bytes.end(), made.begin(), made.end());
  }
};

/// Returns a z near `z_mm` whose low byte looks like a marker.
double with_marker_low_byte(Random& random, double z_mm) {
  const int units = static_cast<int>(z_mm / kUnitMm);
  return ((units & ~0xFF) | 0x80 | integer(random, 0, 15)) * kUnitMm;
}

/// A head in the working volume that is still, has tremor, or moves; the low byte of its z often looks like a marker.
Sent ambiguous_stream(Random& random, int records) {
  Sent sent;
  Eigen::Vector3d place(real(random, -600, 600), real(random, -400, 400), real(random, 300, 1500));
  const bool marker_like = integer(random, 0, 1) == 1;
  if (marker_like) place.z() = with_marker_low_byte(random, place.z());
  constexpr std::array<double, 4> kNoise{0, 0.05, 0.3, 1};
  const double noise_mm = kNoise[static_cast<std::size_t>(integer(random, 0, 3))];
  const double speed_mm = integer(random, 0, 3) == 0 ? 8 : 0;  // per record: half a metre per second
  const Eigen::Vector3d direction(real(random, -1, 1), real(random, -1, 1), real(random, -1, 1));
  const int target = integer(random, 0, 7);
  std::normal_distribution<double> noise(0, noise_mm > 0 ? noise_mm : 1);
  for (int i = 0; i < records; ++i) {
    Eigen::Vector3d seen = place + i * speed_mm * direction;
    if (noise_mm > 0) seen += Eigen::Vector3d(noise(random), noise(random), noise(random));
    if (marker_like && integer(random, 0, 3) > 0) seen.z() = with_marker_low_byte(random, seen.z());
    const int dice = integer(random, 0, 99);
    const Status status = dice < 3 ? Status::search : dice < 5 ? Status::coast : dice < 8 ? Status::caution : Status::track;
    Record record = record_for(seen, status, target);
    if (integer(random, 0, 9) == 0) {  // a device may use a larger exponent than necessary
      record.exponent = 1;
      for (std::int16_t& number : record.numbers) number = static_cast<std::int16_t>(number / 2);
    }
    sent.add(record);
  }
  return sent;
}

struct Joined {
  std::size_t bytes_to_lock = 0;  ///< 0: never
  int false_records = 0;
  int records = 0;
};

Joined join(const Sent& sent, std::size_t from) {
  Joined joined;
  Synchroniser synchroniser;
  for (std::size_t at = from; at < sent.bytes.size(); ++at) {
    const auto records_out = synchroniser.take(sent.bytes[at]);
    if (synchroniser.synchronised() && joined.bytes_to_lock == 0) joined.bytes_to_lock = at + 1 - from;
    if (!records_out) continue;
    ++joined.records;
    const std::size_t number = (at + 1) / kRecordBytes;
    if ((at + 1) % kRecordBytes != 0 || records_out->record != sent.records[number - 1]) ++joined.false_records;
  }
  return joined;
}

/// Whether a reader that takes the first two markers would be at the wrong alignment.
bool naive_reader_is_early(const Sent& sent, std::size_t from) {
  for (std::size_t at = from; at + 1 < sent.bytes.size(); ++at)
    if (is_marker(sent.bytes[at]) && is_marker(sent.bytes[at + 1])) return at % kRecordBytes != 0;
  return false;
}

TEST(DynasightSynchroniser, no_false_record_in_120000_joins) {
  Random random(20041);
  constexpr int kJoins = 120'000, kRecords = 26;
  int false_records = 0, never = 0, naive_early = 0;
  std::vector<double> records_to_lock;
  for (int i = 0; i < kJoins; ++i) {
    const Sent sent = ambiguous_stream(random, kRecords);
    const auto from = static_cast<std::size_t>(integer(random, 0, static_cast<int>(kRecordBytes) - 1));
    const Joined joined = join(sent, from);
    false_records += joined.false_records;
    naive_early += naive_reader_is_early(sent, from);
    if (joined.bytes_to_lock == 0)
      ++never;
    else
      records_to_lock.push_back(static_cast<double>(joined.bytes_to_lock) / kRecordBytes);
  }
  EXPECT_EQ(false_records, 0);
  EXPECT_EQ(never, 0);
  EXPECT_GT(naive_early, kJoins / 50) << "these streams mislead no reader, so they prove nothing";
  std::sort(records_to_lock.begin(), records_to_lock.end());
  const auto at = [&](double share) { return records_to_lock[static_cast<std::size_t>(share * static_cast<double>(kJoins - 1))]; };
  EXPECT_LE(at(0.5), 5);
  EXPECT_LE(at(1), kAgreeingRecordsAmbiguous + 6);
  std::printf("  %d joins, %d where the first two markers mislead; records to lock: median %.1f, p90 %.1f, p99 %.1f, most %.1f\n", kJoins,
              naive_early, at(0.5), at(0.9), at(0.99), at(1));
}

TEST(DynasightSynchroniser, finds_a_still_head_whose_low_byte_looks_like_a_marker) {
  for (int low = 0x80; low < 0x90; ++low)
    for (std::size_t from = 0; from < kRecordBytes; ++from) {
      Sent sent;
      for (int i = 0; i < 40; ++i) sent.add(record_for({-30, 20, (0x3200 | low) * kUnitMm}));
      const Joined joined = join(sent, from);
      EXPECT_EQ(joined.false_records, 0);
      EXPECT_GT(joined.bytes_to_lock, kAgreeingRecordsAmbiguous * kRecordBytes - 8) << "too few to distinguish the two alignments";
      EXPECT_LE(joined.bytes_to_lock, (kAgreeingRecordsAmbiguous + 1) * kRecordBytes);
    }
}

TEST(DynasightSynchroniser, finds_an_ordinary_head_with_the_fourth_complete_record) {
  for (std::size_t from = 0; from < kRecordBytes; ++from) {
    Sent sent;
    for (int i = 0; i < 12; ++i) sent.add(record_for({-30, 20, 640 + 0.35 * i}));
    const Joined joined = join(sent, from);
    EXPECT_EQ(joined.false_records, 0);
    EXPECT_EQ(joined.bytes_to_lock, (from == 0 ? 4 : 5) * kRecordBytes - from);
  }
}

/// A long stream with tremor, read from its start, and the reader's results.
struct Damaged {
  Synchroniser synchroniser;
  std::uint64_t bytes = 0, records = 0;
  std::vector<SynchronisedRecord> records_out;
  void feed(std::span<const std::byte> more) {
    for (const std::byte byte : more) {
      ++bytes;
      const auto found = synchroniser.take(byte);
      if (!found) continue;
      ++records;
      records_out.push_back(*found);
    }
  }
  /// Every byte is part of a record or skipped, apart from those that may still become a record.
  void expect_balance() const {
    const std::uint64_t accounted = records * kRecordBytes + synchroniser.bytes_skipped();
    EXPECT_LE(accounted, bytes);
    EXPECT_LE(bytes - accounted, kRecordBytes);
  }
};

Sent trembling(int records, std::uint64_t seed = 5) {
  Random random(seed);
  Sent sent;
  for (int i = 0; i < records; ++i) sent.add(record_for({real(random, -31, -30), real(random, 20, 21), real(random, 650, 652)}));
  return sent;
}

TEST(DynasightSynchroniser, a_damaged_byte_loses_its_record_only_and_never_the_lock) {
  const Sent sent = trembling(30);
  for (std::size_t where = 0; where < kRecordBytes; ++where)
    for (int bit = 0; bit < 8; ++bit) {
      auto bytes = sent.bytes;
      bytes[10 * kRecordBytes + where] ^= static_cast<std::byte>(1 << bit);
      Damaged run;
      run.feed(bytes);
      run.expect_balance();
      EXPECT_TRUE(run.synchroniser.synchronised());
      EXPECT_EQ(run.synchroniser.losses(), 0u);
      EXPECT_GE(run.records, 26u);  // of the 27 since the lock
      for (const SynchronisedRecord& records_out : run.records_out) {
        if (!records_out.plausible) continue;
        // There is no checksum: an error smaller than a possible step of the head can't be detected.
        EXPECT_LE((records_out.record.position_mm() - Eigen::Vector3d(-30.5, 20.5, 651)).cwiseAbs().maxCoeff(), kMaxStepMm + 2);
      }
    }
}

TEST(DynasightSynchroniser, a_lost_or_extra_byte_loses_a_few_records) {
  const Sent sent = trembling(40);
  for (std::size_t where = 0; where < kRecordBytes; ++where)
    for (int extra = -1; extra < 256; ++extra) {
      const auto at = static_cast<std::ptrdiff_t>(10 * kRecordBytes + where);
      auto bytes = sent.bytes;
      if (extra < 0)
        bytes.erase(bytes.begin() + at);
      else
        bytes.insert(bytes.begin() + at, static_cast<std::byte>(extra));
      Damaged run;
      run.feed(bytes);
      run.expect_balance();
      EXPECT_TRUE(run.synchroniser.synchronised());
      EXPECT_GE(run.records, 40u - 3 - 3);
      EXPECT_LE(run.synchroniser.losses(), 1u);
      for (const SynchronisedRecord& records_out : run.records_out) {
        // An extra byte near the end leaves a record with wrong numbers; if they are within a possible step of the head, this can't be
        // detected.
        if (!records_out.plausible) continue;
        EXPECT_LE((records_out.record.position_mm() - Eigen::Vector3d(-30.5, 20.5, 651)).cwiseAbs().maxCoeff(), kMaxStepMm + 2)
            << where << " " << extra;
      }
      EXPECT_EQ(run.records_out.back().record, sent.records.back());
    }
}

TEST(DynasightSynchroniser, in_20000_slips_every_plausible_position_was_sent) {
  Random random(99);
  constexpr int kSlips = 20'000;
  constexpr std::size_t kRecordsBefore = 30, kRecords = 60;
  std::vector<std::size_t> records_to_regain;
  for (int i = 0; i < kSlips; ++i) {
    const Sent sent = ambiguous_stream(random, kRecords);
    const bool lost = integer(random, 0, 1) == 1;
    const std::size_t at = kRecordsBefore * kRecordBytes + static_cast<std::size_t>(integer(random, 0, 7));
    auto bytes = sent.bytes;
    const auto where = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    if (lost)
      bytes.erase(where);
    else
      bytes.insert(where, static_cast<std::byte>(integer(random, 0, 3) == 0 ? integer(random, 0x80, 0x8F) : integer(random, 0, 255)));
    Synchroniser synchroniser;
    std::size_t regained = 0;
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      const auto records_out = synchroniser.take(bytes[k]);
      if (!records_out || !records_out->plausible || k < at + kRecordBytes) continue;
      const std::size_t end = lost ? k + 2 : k;  // index of the same bytes in the sent stream
      ASSERT_EQ(end % kRecordBytes, 0u);
      ASSERT_EQ(records_out->record, sent.records[end / kRecordBytes - 1]);
      if (regained == 0) regained = end / kRecordBytes - kRecordsBefore;
    }
    ASSERT_NE(regained, 0u);
    records_to_regain.push_back(regained);
  }
  std::sort(records_to_regain.begin(), records_to_regain.end());
  std::printf("  %d slips: places again from record %zu (median), %zu (p99), %zu (most) on\n", kSlips, records_to_regain[kSlips / 2],
              records_to_regain[kSlips * 99 / 100], records_to_regain.back());
  EXPECT_LE(records_to_regain[kSlips / 2], 4u);
}

TEST(DynasightSynchroniser, noise_alone_is_never_a_record) {
  Random random(77);
  Damaged run;
  std::vector<std::byte> noise(1'000'000);
  for (std::byte& byte : noise) byte = static_cast<std::byte>(random() & 0xFF);
  run.feed(noise);
  run.expect_balance();
  EXPECT_EQ(run.records, 0u);
}

TEST(DynasightSynchroniser, detects_the_end_of_the_records) {
  Damaged run;
  run.feed(trembling(10).bytes);
  ASSERT_TRUE(run.synchroniser.synchronised());
  run.feed(std::vector<std::byte>(kMaxBadRecords * kRecordBytes, std::byte{'x'}));
  EXPECT_FALSE(run.synchroniser.synchronised());
  EXPECT_EQ(run.synchroniser.losses(), 1u);
  run.expect_balance();
  run.feed(trembling(10).bytes);
  EXPECT_TRUE(run.synchroniser.synchronised());
}

TEST(DynasightSynchroniser, a_jump_is_plausible_from_its_second_record) {
  Damaged run;
  Sent sent = trembling(10);
  sent.add(record_for({300, 20, 651}));  // a single record: damage
  sent.add(record_for({-30, 20, 651}));
  sent.add(record_for({300, 20, 651}));  // repeated: another person
  sent.add(record_for({301, 20, 651}));
  run.feed(sent.bytes);
  ASSERT_GE(run.records_out.size(), 4u);
  std::vector<bool> plausible;
  for (std::size_t i = run.records_out.size() - 4; i < run.records_out.size(); ++i) plausible.push_back(run.records_out[i].plausible);
  EXPECT_EQ(plausible, (std::vector<bool>{false, true, false, true}));
}

TEST(DynasightSynchroniser, a_returning_head_is_plausible_from_its_second_record) {
  Damaged run;
  Sent sent = trembling(10);
  sent.add(record_for({0, 0, 0}, Status::search));
  sent.add(record_for({-200, 20, 651}));
  sent.add(record_for({-200, 21, 651}));
  run.feed(sent.bytes);
  const std::size_t count = run.records_out.size();
  EXPECT_FALSE(run.records_out[count - 3].plausible);
  EXPECT_FALSE(run.records_out[count - 2].plausible);
  EXPECT_TRUE(run.records_out[count - 1].plausible);
}

TEST(DynasightSynchroniser, a_person_far_aside_is_not_plausible_but_the_stream_stays_synchronised) {
  Damaged run;
  Sent sent = trembling(10);
  for (int i = 0; i < 20; ++i) sent.add(record_for({1500.0 + i, 20, 900}));
  run.feed(sent.bytes);
  EXPECT_TRUE(run.synchroniser.synchronised());
  EXPECT_EQ(run.records, 10u - 3 + 20);
  for (std::size_t i = run.records_out.size() - 20; i < run.records_out.size(); ++i) EXPECT_FALSE(run.records_out[i].plausible);
}

TEST(DynasightSynchroniser, reset_discards_the_stream_and_keeps_the_counts) {
  Damaged run;
  run.feed(trembling(10).bytes);
  const Sent half = trembling(1);
  run.feed(std::span(half.bytes).first(5));
  const auto skipped = run.synchroniser.bytes_skipped();
  run.synchroniser.reset();
  EXPECT_FALSE(run.synchroniser.synchronised());
  EXPECT_EQ(run.synchroniser.bytes_skipped(), skipped + 5);
  run.feed(trembling(3).bytes);
  EXPECT_FALSE(run.synchroniser.synchronised()) << "three records are not enough, whatever came before";
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::dynasight
