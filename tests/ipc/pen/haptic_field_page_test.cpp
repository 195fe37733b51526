#include "ipc/pen/haptic_field_page.h"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

namespace prismesh::ipc {
namespace {

/// Each number of it depends on `seed`.
void fill(HapticField& field, std::uint32_t seed) {
  field.time_ns = seed;
  field.mesh_generation = seed;
  field.before_generation = seed - 1;
  for (HapticBrick* brick : {&field.fine, &field.coarse}) {
    brick->spacing_mm = 0.5;
    brick->count[0] = 3 + static_cast<int>(seed % 2);
    brick->count[1] = 5;
    brick->count[2] = 7;
    const int nodes = brick->count[0] * 35;
    for (int i = 0; i < nodes; ++i) {
      brick->distance_mm[i] = static_cast<float>(seed + static_cast<std::uint32_t>(i));
      brick->still_mm[i] = brick->distance_mm[i] + 1;
      brick->nearest[i] = static_cast<std::int32_t>(seed) + i;
    }
  }
  field.max_moved_mm = seed;
  field.moved_count = 3;
  for (int i = 0; i < 3; ++i) field.moved[i].element = static_cast<std::int32_t>(seed) + i;
  for (int i = 0; i <= kBuckets; ++i) field.bucket_begin[i] = i < kBuckets ? 0 : 5;
  for (int i = 0; i < 5; ++i) field.bucket_entry[i] = static_cast<std::uint16_t>(seed + static_cast<std::uint32_t>(i));
}

void expect_filled(const HapticField& field, std::uint32_t seed) {
  ASSERT_EQ(field.time_ns, seed);
  for (const HapticBrick* brick : {&field.fine, &field.coarse}) {
    ASSERT_EQ(brick->count[0], 3 + static_cast<int>(seed % 2));
    const int nodes = brick->count[0] * 35;
    for (int i = 0; i < nodes; ++i) {
      ASSERT_EQ(brick->distance_mm[i], static_cast<float>(seed + static_cast<std::uint32_t>(i)));
      ASSERT_EQ(brick->still_mm[i], brick->distance_mm[i] + 1);
      ASSERT_EQ(brick->nearest[i], static_cast<std::int32_t>(seed) + i);
    }
  }
  for (int i = 0; i < 3; ++i) ASSERT_EQ(field.moved[i].element, static_cast<std::int32_t>(seed) + i);
  for (int i = 0; i < 5; ++i) ASSERT_EQ(field.bucket_entry[i], static_cast<std::uint16_t>(seed + static_cast<std::uint32_t>(i)));
}

TEST(HapticFieldPages, give_the_newest_field_and_its_number) {
  HapticFieldPage page = HapticFieldPage::create().value();
  HapticFieldPageReader reader = HapticFieldPageReader::map(page.descriptor()).value();
  const auto written = std::make_unique<HapticField>(), read = std::make_unique<HapticField>();
  EXPECT_FALSE(reader.read(*read));
  for (std::uint32_t seed = 1; seed < 6; ++seed) {
    fill(*written, seed);
    page.publish(*written);
    ASSERT_TRUE(reader.read(*read));
    EXPECT_EQ(read->number, seed);
    expect_filled(*read, seed);
  }
}

TEST(HapticFieldPages, are_never_read_torn) {
  HapticFieldPage page = HapticFieldPage::create().value();
  HapticFieldPageReader reader = HapticFieldPageReader::map(page.descriptor()).value();
  std::atomic<bool> end = false;
  std::thread writer([&] {
    const auto field = std::make_unique<HapticField>();
    for (std::uint32_t seed = 1; !end; ++seed) {
      fill(*field, seed);
      page.publish(*field);
    }
  });
  const auto read = std::make_unique<HapticField>();
  int whole = 0;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (whole < 300 && std::chrono::steady_clock::now() < until)
    if (reader.read(*read)) {
      ++whole;
      expect_filled(*read, static_cast<std::uint32_t>(read->number));
      if (testing::Test::HasFatalFailure()) break;
    } else {
      EXPECT_EQ(read->fine.count[0], 0);
    }
  end = true;
  writer.join();
  EXPECT_EQ(whole, 300);
}

TEST(HapticFieldPages, bound_what_a_false_writer_says) {
  HapticFieldPage page = HapticFieldPage::create().value();
  HapticFieldPageReader reader = HapticFieldPageReader::map(page.descriptor()).value();
  const auto field = std::make_unique<HapticField>(), read = std::make_unique<HapticField>();
  fill(*field, 1);
  for (std::int32_t& count : field->fine.count) count = 1 << 30;
  field->coarse.count[1] = -5;
  field->moved_count = 1 << 30;
  field->bucket_begin[kBuckets] = ~0U;
  page.publish(*field);
  EXPECT_TRUE(reader.read(*read));
}

TEST(HapticFieldPages, of_another_kind_or_unsealed_are_refused) {
  EXPECT_FALSE(HapticFieldPageReader::map(Descriptor(::memfd_create("open", 0))));
  const Descriptor small = make_shared_memory("small", 4096).value();
  ASSERT_TRUE(seal_for_readers(small));
  EXPECT_FALSE(HapticFieldPageReader::map(small));
  const Descriptor unsealed = make_shared_memory("unsealed", sizeof(HapticFieldPageLayout)).value();
  EXPECT_FALSE(HapticFieldPageReader::map(unsealed));
  ASSERT_TRUE(seal_for_readers(unsealed));
  EXPECT_FALSE(HapticFieldPageReader::map(unsealed)) << "no magic number";
}

}  // namespace
}  // namespace prismesh::ipc
