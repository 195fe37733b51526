#include "daemon/modeld/watchdog.h"

#include <future>

#include <gtest/gtest.h>

namespace prismesh::modeld {
namespace {

using namespace std::chrono_literals;

TEST(Watchdog, silence_is_told_after_so_many_beats_without_a_sign) {
  Pulse pulse;
  Silence silence("it", pulse, 3);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(silence.beat()) << "no signs are expected";
  pulse.begin();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(silence.beat());
  EXPECT_TRUE(silence.beat());
}

TEST(Watchdog, each_sign_begins_the_count_anew) {
  Pulse pulse;
  Silence silence("it", pulse, 3);
  pulse.begin();
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(silence.beat()) << i;
    if (i % 3 == 0) pulse.sign();
  }
  pulse.end();
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(silence.beat()) << "it is over";
  // Work that begins and ends between two beats is another work.
  for (int i = 0; i < 30; ++i) {
    pulse.begin();
    EXPECT_FALSE(silence.beat());
    pulse.end();
  }
}

TEST(Watchdog, tells_once_what_is_silent) {
  Pulse lively, hung;
  std::promise<std::string> told;
  std::vector<Silence> watched;
  watched.emplace_back("lively", lively, 1);
  watched.emplace_back("hung", hung, 2);
  hung.begin();
  const Watchdog watchdog(std::move(watched), 1ms, [&](const std::string& what) { told.set_value(what); });
  EXPECT_EQ(told.get_future().get(), "hung");
}

}  // namespace
}  // namespace prismesh::modeld
