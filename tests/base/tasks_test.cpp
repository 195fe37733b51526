#include "base/tasks.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

class Tasks : public testing::TestWithParam<std::size_t> {};

TEST_P(Tasks, run_once_each) {
  std::vector<std::atomic<int>> runs(100);
  run_tasks(
      runs.size(), GetParam(), [&](std::size_t i, const auto&) { ++runs[i]; }, [] {});
  for (const std::atomic<int>& count : runs) EXPECT_EQ(count, 1);
}

TEST_P(Tasks, of_none_is_done_at_once) {
  run_tasks(
      0, GetParam(), [](std::size_t, const auto&) { ADD_FAILURE(); }, [] { ADD_FAILURE(); });
}

TEST_P(Tasks, are_watched_on_the_thread_that_started_them) {
  const std::thread::id here = std::this_thread::get_id();
  std::atomic<int> done = 0;
  int seen = 0, watches = 0;
  run_tasks(
      8, GetParam(),
      [&](std::size_t, const auto& wake) {
        ++done;
        wake();
      },
      [&] {
        EXPECT_EQ(std::this_thread::get_id(), here);
        seen = done;
        ++watches;
      });
  EXPECT_EQ(seen, 8);  // the last wake isn't lost
  EXPECT_GE(watches, 1);
  EXPECT_LE(watches, 8);
}

TEST_P(Tasks, wait_for_a_watch_while_they_run) {
  // The task ends only once it was watched.
  std::atomic<bool> watched = false;
  run_tasks(
      2, GetParam(),
      [&](std::size_t, const auto& wake) {
        wake();
        while (!watched) std::this_thread::yield();
      },
      [&] { watched = true; });
  EXPECT_TRUE(watched);
}

TEST_P(Tasks, throw_what_the_first_of_them_threw) {
  std::string caught;
  try {
    run_tasks(
        20, GetParam(),
        [](std::size_t i, const auto&) {
          if (i == 3 || i == 17) throw std::runtime_error("task " + std::to_string(i));
        },
        [] {});
  } catch (const std::runtime_error& error) {
    caught = error.what();
  }
  EXPECT_EQ(caught, "task 3");
}

INSTANTIATE_TEST_SUITE_P(Threads, Tasks, testing::Values(std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5}));

}  // namespace
}  // namespace prismesh
