#include "base/parallel_for.h"

#include <atomic>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

using Ranges = std::set<std::pair<std::size_t, std::size_t>>;

Ranges ranges_of(std::size_t count, std::size_t grain) {
  std::mutex mutex;
  Ranges ranges;
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    const std::scoped_lock lock(mutex);
    EXPECT_TRUE(ranges.emplace(begin, end).second) << begin;
  });
  return ranges;
}

TEST(ParallelFor, ranges_depend_on_count_and_grain_alone) {
  EXPECT_EQ(ranges_of(10, 4), (Ranges{{0, 4}, {4, 8}, {8, 10}}));
  EXPECT_EQ(ranges_of(4, 4), (Ranges{{0, 4}}));
  EXPECT_EQ(ranges_of(3, 0), (Ranges{{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(ranges_of(0, 8), Ranges{});
}

TEST(ParallelFor, every_index_comes_once) {
  std::vector<int> visits(100'003, 0);
  parallel_for(visits.size(), 97, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  for (const int visit : visits) ASSERT_EQ(visit, 1);
}

TEST(ParallelFor, may_be_called_from_within) {
  std::atomic<std::size_t> sum{0};
  parallel_for(8, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parallel_for(100, 10, [&](std::size_t first, std::size_t last) { sum += last - first; });
  });
  EXPECT_EQ(sum, 800u);
}

}  // namespace
}  // namespace prismesh
