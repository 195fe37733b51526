#include "mesh/model/id_index.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace prismesh::mesh {
namespace {

using Ids = std::vector<std::int64_t>;

/// Compares with a map, for every id there is and those beside them.
void expect_like_a_map(const Ids& ids) {
  const IdIndex index{ids};
  std::map<std::int64_t, std::uint32_t> wanted;
  Ids duplicates;
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (!wanted.emplace(ids[i], static_cast<std::uint32_t>(i)).second) duplicates.push_back(ids[i]);
  std::sort(duplicates.begin(), duplicates.end());
  duplicates.erase(std::unique(duplicates.begin(), duplicates.end()), duplicates.end());
  EXPECT_EQ(index.duplicates(), duplicates);
  ASSERT_EQ(index.size(), wanted.size());
  std::size_t rank = 0;
  for (const auto& [id, at] : wanted) {
    ASSERT_EQ(index.at(rank), (std::pair<std::int64_t, std::uint32_t>(id, at)));
    ASSERT_EQ(index.lower_bound(id), rank);
    ASSERT_EQ(index.find(id), at);
    for (const std::int64_t beside : {id - 1, id + 1})
      if (!wanted.count(beside)) {
        ASSERT_EQ(index.find(beside), IdIndex::kNotFound);
      }
    ASSERT_EQ(index.lower_bound(id + 1), rank + 1);
    ++rank;
  }
}

TEST(IdIndex, is_like_a_map_whatever_the_ids) {
  Ids counting(5000), gaps, sparse, backwards, shuffled, twice;
  for (std::size_t i = 0; i < counting.size(); ++i) {
    const auto n = static_cast<std::int64_t>(i);
    counting[i] = 700 + n;
    gaps.push_back(n * 3 + n % 2);
    sparse.push_back(n * n * 1000003);
    backwards.push_back(10000 - n);
    twice.push_back(n / 2);
  }
  std::mt19937 random(3);
  shuffled = sparse;
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  for (Ids* ids : {&counting, &gaps, &sparse, &backwards, &shuffled, &twice}) expect_like_a_map(*ids);
  std::shuffle(twice.begin(), twice.end(), random);
  shuffled.insert(shuffled.end(), sparse.begin(), sparse.begin() + 100);
  expect_like_a_map(twice);
  expect_like_a_map(shuffled);
  expect_like_a_map({42});
  expect_like_a_map({5, 5, 5});
  expect_like_a_map({1, 1, 4'000'000'000, 4'000'000'000, 4'000'000'000});
}

TEST(IdIndex, finds_ids_of_parts_that_begin_at_round_numbers) {
  Ids ids;
  for (std::int64_t part = 1; part < 40; ++part)
    for (std::int64_t i = 0; i < 100 + part; ++i) ids.push_back(part * part * 10'000'000 + 1 + i + (i > 50 ? 7 : 0));
  expect_like_a_map(ids);
  std::mt19937 random(5);
  std::shuffle(ids.begin(), ids.end(), random);
  expect_like_a_map(ids);
}

TEST(IdIndex, is_empty_without_ids) {
  const IdIndex index{Ids{}};
  EXPECT_EQ(index.size(), 0u);
  EXPECT_EQ(index.find(0), IdIndex::kNotFound);
  EXPECT_EQ(index.lower_bound(5), 0u);
}

TEST(IdIndex, bears_the_farthest_ids) {
  const std::int64_t low = std::numeric_limits<std::int64_t>::min(), high = std::numeric_limits<std::int64_t>::max();
  const IdIndex index{Ids{high, 0, low}};
  EXPECT_EQ(index.find(high), 0u);
  EXPECT_EQ(index.find(0), 1u);
  EXPECT_EQ(index.find(low), 2u);
  EXPECT_EQ(index.find(7), IdIndex::kNotFound);
  EXPECT_EQ(index.lower_bound(1), 2u);
}

}  // namespace
}  // namespace prismesh::mesh
