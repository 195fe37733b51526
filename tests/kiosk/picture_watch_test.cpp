#include "kiosk/picture_watch.h"

#include <gtest/gtest.h>

namespace prismesh::kiosk {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

struct Told {
  int ready = 0, alive = 0;
  std::int64_t allowed_ns = 0;
  PictureWatch watch;
  explicit Told(std::optional<std::int64_t> period_ns = kSecond)
      : watch({period_ns, [this] { ++ready; }, [this] { ++alive; }, [this](std::int64_t ns) { allowed_ns = ns; }}) {}
};

TEST(PictureWatch, is_ready_with_the_first_picture_once) {
  Told told;
  told.watch.turn(kSecond, true);
  EXPECT_EQ(told.ready, 0);
  told.watch.shown();
  told.watch.shown();
  EXPECT_EQ(told.ready, 1);
}

TEST(PictureWatch, is_alive_at_rest_once_a_period) {
  Told told;
  for (std::int64_t now = 10 * kSecond; now < 20 * kSecond; now += kSecond / 10) told.watch.turn(now, false);
  EXPECT_EQ(told.alive, 10);
  EXPECT_EQ(told.watch.next_ns(), 20 * kSecond);
}

TEST(PictureWatch, is_alive_while_pieces_of_a_picture_are_drawn) {
  Told told;
  for (std::int64_t now = 100 * kSecond; now < 130 * kSecond; now += kSecond) {
    told.watch.draws_piece();
    told.watch.turn(now, true);
  }
  EXPECT_EQ(told.alive, 30);
  EXPECT_EQ(told.ready, 0) << "no picture has appeared";
}

TEST(PictureWatch, is_not_alive_while_a_picture_does_not_appear) {
  Told told;
  std::int64_t now = 100 * kSecond;
  for (; now <= 100 * kSecond + PictureWatch::kMaxWaitNs; now += kSecond) told.watch.turn(now, true);
  const int before = told.alive;
  EXPECT_GT(before, 5) << "a picture may take a while";
  for (int i = 0; i < 10; ++i) told.watch.turn(now += kSecond, true);
  EXPECT_EQ(told.alive, before);
  told.watch.shown();
  told.watch.turn(now += kSecond, true);
  EXPECT_EQ(told.alive, before + 1) << "it has appeared, so the next one has its own time";
}

TEST(PictureWatch, asks_for_more_time_before_it_draws_a_larger_model) {
  Told told;
  told.watch.draws(1000);
  EXPECT_EQ(told.allowed_ns, 2 * kSecond + 1000 * PictureWatch::kShellNs);
  told.watch.draws(1050);
  EXPECT_EQ(told.allowed_ns, 2 * kSecond + 1000 * PictureWatch::kShellNs) << "hardly larger";
  told.watch.draws(5'000'000);
  EXPECT_EQ(told.allowed_ns, 17 * kSecond);
}

TEST(PictureWatch, tells_nothing_where_nobody_asks) {
  Told told(std::nullopt);
  for (std::int64_t now = 0; now < 100 * kSecond; now += kSecond) told.watch.turn(now, false);
  EXPECT_EQ(told.alive, 0);
  EXPECT_EQ(told.watch.next_ns(), std::nullopt);
}

}  // namespace
}  // namespace prismesh::kiosk
