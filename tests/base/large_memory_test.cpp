#include "base/large_memory.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

TEST(LargeBlock, is_zero_and_stays_where_it_is_when_moved) {
  for (const std::size_t size : {std::size_t{1}, kLargePage - 1, kLargePage, 3 * kLargePage + 17}) {
    LargeBlock block(size);
    ASSERT_EQ(block.size(), size);
    EXPECT_TRUE(std::all_of(block.data(), block.data() + size, [](char c) { return c == 0; }));
    block.data()[size - 1] = 'x';
    char* const data = block.data();
    const LargeBlock moved = std::move(block);
    EXPECT_EQ(moved.data(), data);
    EXPECT_EQ(moved.data()[size - 1], 'x');
  }
}

TEST(LargeBlock, begins_at_a_large_page_and_is_given_back_whole) {
  // In pages of the kernel's; other threads' heaps and the like come and go.
  const auto mapped_pages = [] {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages;
  };
  const std::size_t size = 3 * kLargePage + 17;
  for (int i = 0; i < 8; ++i) LargeBlock warm(size);
  const std::size_t before = mapped_pages();
  std::vector<LargeBlock> blocks;
  for (int i = 0; i < 100; ++i) {
    blocks.emplace_back(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks.back().data()) % kLargePage, 0U);
  }
  EXPECT_LE(mapped_pages() - before, std::size_t{400} * kLargePage / 4096 + 4096) << "no more than whole large pages";
  blocks.clear();
  EXPECT_LE(mapped_pages(), before + 4096);
}

TEST(LargeBlock, that_no_machine_has_is_refused) {
  for (const std::size_t size : {SIZE_MAX, SIZE_MAX - kLargePage, SIZE_MAX / 2 + 2, SIZE_MAX / 4})
    EXPECT_THROW(LargeBlock block(size), std::bad_alloc);
}

TEST(LargePool, aligns_what_is_made) {
  struct Odd {
    std::array<char, 65> bytes;
  };
  LargePool pool;
  std::vector<std::shared_ptr<Odd>> all;
  for (int i = 0; i < 10; ++i) {
    all.push_back(pool.make<Odd>());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(all.back().get()) % 64, 0U) << i;
  }
}

TEST(LargePool, keeps_what_is_made_apart_and_longer_than_itself) {
  using Chunk = std::array<std::uint64_t, 20000>;
  std::vector<std::shared_ptr<Chunk>> chunks(200);
  {
    LargePool pool;
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < chunks.size(); i += 4) {
          chunks[i] = pool.make<Chunk>();
          chunks[i]->fill(i);
        }
      });
    for (std::thread& thread : threads) thread.join();
  }
  for (std::size_t i = 0; i < chunks.size(); i += 2) chunks[i] = nullptr;
  for (std::size_t i = 1; i < chunks.size(); i += 2)
    EXPECT_TRUE(std::all_of(chunks[i]->begin(), chunks[i]->end(), [&](std::uint64_t value) { return value == i; })) << i;
}

TEST(ReserveLarge, leaves_content_alone) {
  std::vector<int> values = {1, 2, 3};
  reserve_large(values, 4000000);
  EXPECT_GE(values.capacity(), 4000000u);
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3}));
}

}  // namespace
}  // namespace prismesh
