// Time at which a picture lights up, with and without refresh times from the display.
#include <cstdint>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "kiosk/stereo/lit_time.h"

namespace prismesh::kiosk::stereo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Draws pictures with these draw times, one after the other.
void draw(PictureTiming& timing, ManualClock& clock, std::initializer_list<std::int64_t> lengths_ms) {
  for (const std::int64_t length : lengths_ms) {
    timing.begun(clock.now_ns());
    clock.advance_ns(length * kMs);
    timing.drawn(clock.now_ns());
  }
}

TEST(LitTime, without_refresh_times_the_wait_is_half_a_period) {
  ManualClock clock;
  PictureTiming timing({20 * kMs, 7 * kMs});
  draw(timing, clock, {4, 4, 4});
  const std::int64_t now = clock.now_ns();
  const LitTime lit = timing.lit(now);
  EXPECT_EQ(lit.from_ns - now, (4 + 10 + 10 + 7) * kMs) << "drawing, waiting, scan-out to the middle, the panel";
  EXPECT_EQ(lit.until_ns - lit.from_ns, 20 * kMs) << "a picture stays for a period";
}

TEST(LitTime, a_reported_refresh_fixes_the_phase) {
  ManualClock clock;
  clock.advance_ns(1000 * kMs);
  PictureTiming timing({20 * kMs, 0});
  draw(timing, clock, {4, 4, 4});
  const std::int64_t now = clock.now_ns();
  timing.refreshed(now - 3 * kMs, now);
  EXPECT_EQ(timing.lit(now).from_ns, now - 3 * kMs + 20 * kMs + 10 * kMs) << "drawn after 4 ms, it waits for the refresh in 17";
  timing.refreshed(now - 17 * kMs, now);
  EXPECT_EQ(timing.lit(now).from_ns, now - 17 * kMs + 40 * kMs + 10 * kMs) << "too late for the refresh in 3 ms";
}

TEST(LitTime, impossible_refresh_times_are_ignored) {
  ManualClock clock;
  clock.advance_ns(5000 * kMs);
  PictureTiming timing({20 * kMs, 0});
  draw(timing, clock, {4});
  const std::int64_t now = clock.now_ns();
  const std::int64_t estimated = timing.lit(now).from_ns;
  for (const std::int64_t refresh : {std::int64_t(0), now + 5 * kMs, now - 2000 * kMs}) {
    timing.refreshed(refresh, now);
    EXPECT_EQ(timing.lit(now).from_ns, estimated) << refresh;
  }
  timing.refreshed(now - 3 * kMs, now);
  EXPECT_EQ(timing.lit(now + 3000 * kMs).from_ns - 3000 * kMs, estimated) << "an old phase is ignored";
}

TEST(LitTime, one_slow_picture_changes_only_the_time_that_a_picture_stays) {
  ManualClock clock;
  PictureTiming timing({20 * kMs, 0});
  draw(timing, clock, {4, 4, 90, 4, 4});
  const LitTime lit = timing.lit(clock.now_ns());
  EXPECT_EQ(lit.from_ns - clock.now_ns(), (4 + 10 + 10) * kMs);
  EXPECT_EQ(lit.until_ns - lit.from_ns, 90 * kMs) << "the next one may be slow again";
}

TEST(LitTime, pictures_are_begun_once_per_refresh) {
  ManualClock clock;
  PictureTiming timing({20 * kMs, 0});
  const std::int64_t begun = clock.now_ns();
  draw(timing, clock, {4});
  EXPECT_EQ(timing.next_begin_ns(), begun + 20 * kMs);
}

}  // namespace
}  // namespace prismesh::kiosk::stereo
