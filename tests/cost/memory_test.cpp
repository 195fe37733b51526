#include "tests/cost/memory.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace prismesh::cost {
namespace {

struct alignas(64) Wide {
  double values[8];
};

TEST(MemoryPeak, is_the_max_at_once_above_what_there_was) {
  const auto before = std::make_unique<std::vector<char>>(50'000);
  begin_memory_peak();
  EXPECT_EQ(memory_peak_bytes(), 0u);
  { const std::vector<char> first(100'000); }
  { const std::vector<char> second(60'000); }
  EXPECT_GE(memory_peak_bytes(), 100'000u);
  EXPECT_LE(memory_peak_bytes(), 101'000u) << "the library rounds up, and the two weren't there at once";
  begin_memory_peak();
  {
    const std::vector<char> first(100'000);
    const std::vector<Wide> second(1'000);
  }
  EXPECT_GE(memory_peak_bytes(), 164'000u) << "both at once, the aligned one too";
  EXPECT_LE(memory_peak_bytes(), 166'000u);
}

TEST(MemoryPeak, does_not_fall_below_nothing_when_earlier_memory_is_freed) {
  auto before = std::make_unique<std::vector<char>>(50'000);
  begin_memory_peak();
  before.reset();
  const std::vector<char> smaller(10'000);
  EXPECT_EQ(memory_peak_bytes(), 0u);
}

}  // namespace
}  // namespace prismesh::cost
