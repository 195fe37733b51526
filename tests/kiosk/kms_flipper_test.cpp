#include "kiosk/display/kms/flipper.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kiosk/fake_card.h"

namespace prismesh::kiosk::display::kms {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod = FakeCard::kPeriodNs;

class Flips : public testing::Test {
 protected:
  Flips() {
    clock.advance_ns(50 * kPeriod + 1 * kMs);
    flipper.set_output(*choose_output(card.state(), {}));
  }
  void show(ObjectId picture) { ASSERT_TRUE(flipper.show(picture)); }
  void after(std::int64_t ns) {
    clock.advance_ns(ns);
    ASSERT_TRUE(flipper.turn());
  }
  const Change& last() const { return card.commits.back(); }
  std::uint64_t on_connector(const char* name) { return card.value(card.state().connectors[0].properties, name); }

  ManualClock clock;
  FakeCard card{clock};
  Flipper flipper{card, clock};
};

TEST_F(Flips, sets_the_mode_with_the_first_picture_only) {
  show(1);
  EXPECT_TRUE(last().may_set_mode);
  EXPECT_EQ(card.picture(), 1U);
  EXPECT_EQ(std::memcmp(card.mode().data(), fake_mode(1920, 1200, 100).timings.data(), 12), 0);
  EXPECT_EQ(card.value(card.state().planes[0].properties, "SRC_W"), 1920U << 16U);
  EXPECT_EQ(card.value(card.state().planes[0].properties, "CRTC_W"), 1920U);
  after(kPeriod);
  show(2);
  EXPECT_FALSE(last().may_set_mode);
  EXPECT_EQ(last().settings.size(), 1U);
  EXPECT_EQ(flipper.counts().modes, 1U);
}

TEST_F(Flips, tells_when_each_picture_appeared_and_which_are_free) {
  show(1);
  EXPECT_FALSE(flipper.shown_ns());
  after(kPeriod);
  EXPECT_EQ(flipper.shown_ns(), 51 * kPeriod);
  EXPECT_THAT(flipper.take_released(), IsEmpty());
  show(2);
  after(kPeriod);
  EXPECT_EQ(flipper.shown_ns(), 52 * kPeriod);
  EXPECT_THAT(flipper.take_released(), ElementsAre(1U));
  EXPECT_EQ(flipper.counts().missed, 0U);
}

TEST_F(Flips, waits_for_no_flip_and_shows_the_newest_picture) {
  show(1);
  show(2);
  show(3);
  show(4);
  EXPECT_EQ(card.picture(), 1U);
  EXPECT_THAT(flipper.take_released(), ElementsAre(2U, 3U));
  after(kPeriod);
  EXPECT_EQ(card.picture(), 4U);
  EXPECT_EQ(flipper.counts().replaced, 2U);
}

TEST_F(Flips, counts_the_refreshes_that_a_picture_missed) {
  show(1);
  after(kPeriod);
  card.skips = 3;
  show(2);
  after(4 * kPeriod);
  EXPECT_EQ(flipper.counts().missed, 3U);
  EXPECT_EQ(flipper.shown_ns(), 55 * kPeriod);
}

TEST_F(Flips, tries_again_while_the_card_is_busy) {
  show(1);
  after(kPeriod);
  card.fails = {EBUSY, EBUSY};
  show(2);
  EXPECT_EQ(card.picture(), 1U);
  ASSERT_TRUE(flipper.next_ns());
  EXPECT_LE(*flipper.next_ns(), clock.now_ns() + kPeriod);
  after(*flipper.next_ns() - clock.now_ns());
  after(*flipper.next_ns() - clock.now_ns());
  EXPECT_EQ(card.picture(), 2U);
  EXPECT_EQ(flipper.counts().busy, 2U);
}

TEST_F(Flips, gives_up_a_card_that_stays_busy) {
  show(1);
  after(kPeriod);
  card.fails.assign(100'000, EBUSY);
  show(2);
  Result<void> turned;
  std::int64_t waited = 0;
  while (turned && waited < 20 * Flipper::kLostNs) {
    waited += 100 * kMs;
    clock.advance_ns(100 * kMs);
    turned = flipper.turn();
  }
  ASSERT_FALSE(turned);
  EXPECT_THAT(turned.error().text(), HasSubstr("/dev/dri/card7: the graphics card has been busy for ten seconds"));
  EXPECT_LE(waited, Flipper::kHungNs + kMs * 200);
}

TEST_F(Flips, sets_the_mode_anew_when_a_flip_is_refused) {
  show(1);
  after(kPeriod);
  card.lose_mode();
  show(2);
  EXPECT_TRUE(last().may_set_mode);
  EXPECT_EQ(card.picture(), 2U);
  EXPECT_EQ(flipper.counts().modes, 2U);
}

TEST_F(Flips, says_which_mode_the_card_refuses) {
  card.refused = {"MODE_ID"};
  const Result<void> shown = flipper.show(1);
  ASSERT_FALSE(shown);
  EXPECT_EQ(shown.error().text(),
            "DP-1: the graphics card refuses the mode 1920x1200 at 100.00 Hz (Invalid argument): [display] mode names another");
}

TEST_F(Flips, sets_the_mode_anew_when_an_event_never_comes) {
  show(1);
  after(kPeriod);
  card.loses_event = true;
  show(2);
  after(kPeriod);
  EXPECT_TRUE(flipper.next_ns());
  after(Flipper::kLostNs);
  EXPECT_EQ(flipper.counts().lost, 1U);
  EXPECT_EQ(flipper.counts().modes, 2U);
  EXPECT_EQ(card.picture(), 2U);
  after(kPeriod);
  EXPECT_EQ(flipper.counts().shown, 2U);
  EXPECT_THAT(flipper.take_released(), ElementsAre(1U));
}

TEST_F(Flips, takes_a_late_event_for_what_it_is) {
  show(1);
  after(kPeriod);
  card.event_delay_ns = 5 * kPeriod;
  show(2);
  after(3 * kPeriod);
  EXPECT_EQ(flipper.counts().shown, 1U);
  after(3 * kPeriod);
  EXPECT_EQ(flipper.counts().shown, 2U);
  EXPECT_EQ(flipper.counts().lost, 0U);
  EXPECT_EQ(flipper.shown_ns(), 52 * kPeriod);  // when it appeared, not when that was told
  EXPECT_EQ(flipper.counts().missed, 0U);
}

TEST_F(Flips, ignores_the_event_of_a_picture_that_was_given_up) {
  show(1);
  after(kPeriod);
  card.loses_event = true;
  show(2);
  after(kPeriod);
  after(Flipper::kLostNs);
  card.late = {{2, 0, clock.now_ns()}};
  ASSERT_TRUE(flipper.turn());
  EXPECT_EQ(flipper.counts().shown, 1U);
  after(kPeriod);
  EXPECT_EQ(flipper.counts().shown, 2U);
}

TEST_F(Flips, trusts_no_time_of_another_clock) {
  card.time_is_wrong = true;
  show(1);
  after(kPeriod);
  EXPECT_EQ(flipper.counts().shown, 1U);
  EXPECT_FALSE(flipper.shown_ns());
}

TEST_F(Flips, shows_nothing_while_another_program_has_the_screen) {
  show(1);
  after(kPeriod);
  show(2);
  flipper.pause();
  card.stolen = true;
  card.end_flip();
  const std::size_t before = card.commits.size();
  show(3);
  show(4);
  after(10 * Flipper::kLostNs);
  EXPECT_EQ(card.commits.size(), before);
  EXPECT_THAT(flipper.take_released(), ElementsAre(1U, 3U));
  card.stolen = false;
  card.lose_mode();
  ASSERT_TRUE(flipper.resume());
  EXPECT_EQ(card.picture(), 4U);
  EXPECT_TRUE(last().may_set_mode);
}

TEST_F(Flips, shows_the_last_picture_again_when_the_screen_is_ours_again) {
  show(1);
  after(kPeriod);
  flipper.pause();
  card.lose_mode();
  ASSERT_TRUE(flipper.resume());
  EXPECT_EQ(card.picture(), 1U);
  after(kPeriod);
  EXPECT_EQ(flipper.counts().shown, 2U);
  EXPECT_THAT(flipper.take_released(), IsEmpty());
}

TEST_F(Flips, waits_while_it_has_lost_the_right_to_show) {
  show(1);
  after(kPeriod);
  card.stolen = true;
  show(2);
  EXPECT_EQ(card.picture(), 1U);
  card.stolen = false;
  after(2 * Flipper::kLostNs);
  EXPECT_EQ(card.picture(), 2U);
}

TEST_F(Flips, says_that_the_card_is_gone) {
  show(1);
  after(kPeriod);
  card.gone = true;
  const Result<void> shown = flipper.show(2);
  ASSERT_FALSE(shown);
  EXPECT_THAT(shown.error().text(), HasSubstr("/dev/dri/card7: the graphics card shows no more pictures (No such device)"));
}

TEST_F(Flips, clears_what_another_program_has_left) {
  card.state().planes[1].properties["CRTC_ID"].value = FakeCard::kCrtc;
  card.state().planes[1].properties["FB_ID"].value = 99;
  show(1);
  EXPECT_EQ(card.value(card.state().planes[1].properties, "FB_ID"), 0U);
}

TEST_F(Flips, sets_the_link_so_that_pixels_arrive_unchanged) {
  card.state().crtcs[0].properties["CTM"].value = 77;
  card.state().crtcs[0].properties["GAMMA_LUT"].value = 78;
  show(1);
  EXPECT_EQ(on_connector("scaling mode"), 0U);
  EXPECT_EQ(on_connector("Broadcast RGB"), 1U);
  EXPECT_EQ(on_connector("max bpc"), 8U);
  EXPECT_EQ(card.value(card.state().crtcs[0].properties, "CTM"), 0U);
  EXPECT_EQ(card.value(card.state().crtcs[0].properties, "GAMMA_LUT"), 0U);
  EXPECT_THAT(read_link(card.state(), flipper.output()).differ, IsEmpty());
}

TEST_F(Flips, leaves_out_what_the_driver_refuses_and_says_so) {
  card.refused = {"Broadcast RGB", "CTM"};
  show(1);
  EXPECT_EQ(card.picture(), 1U);
  EXPECT_EQ(on_connector("max bpc"), 8U);
  EXPECT_THAT(flipper.refused(), ElementsAre("DP-1: the graphics card refuses to set its colour range (\"Broadcast RGB\") to Full",
                                             "DP-1: the graphics card refuses to set its colour matrix (\"CTM\") to 0"));
}

TEST_F(Flips, drops_the_blob_of_a_mode_that_is_left) {
  show(1);
  flipper.set_output(*choose_output(card.state(), {"", {1024, 768}, 0}));
  EXPECT_EQ(card.blobs.size(), 1U);
  EXPECT_THAT(flipper.take_released(), ElementsAre(1U));
}

// Whatever happens, no picture is lost or released twice, and the newest one is shown in the end.
TEST(FlipsAtRandom, keep_each_picture_until_the_display_has_another) {
  std::mt19937 random(20261127);
  const auto chance = [&](unsigned percent) { return random() % 100 < percent; };
  // The card may refuse the same picture twice.
  const auto may_refuse = [](const Result<void>& done) {
    if (!done) {
      EXPECT_THAT(done.error().text(), HasSubstr("refuses the mode"));
    }
  };
  ManualClock clock;
  clock.advance_ns(Flipper::kLostNs);
  FakeCard card(clock);
  Flipper flipper(card, clock);
  flipper.set_output(*choose_output(card.state(), {}));
  std::set<ObjectId> held;
  ObjectId newest = 0;
  bool paused = false;
  for (int step = 0; step < 200'000; ++step) {
    if (chance(1)) card.fails.push_back(chance(50) ? EBUSY : EINVAL);
    if (chance(1)) card.loses_event = true;
    if (chance(1)) card.lose_mode();
    if (chance(2)) card.skips = random() % 4;
    card.event_delay_ns = chance(5) ? static_cast<std::int64_t>(random() % 30) * kMs : 0;
    if (chance(1)) {
      paused = !paused;
      if (paused) {
        flipper.pause();
        card.end_flip();
      } else {
        may_refuse(flipper.resume());
      }
    }
    if (chance(40)) {
      held.insert(++newest);
      may_refuse(flipper.show(newest));
    }
    clock.advance_ns(static_cast<std::int64_t>(random() % 20) * kMs);
    may_refuse(flipper.turn());
    for (const ObjectId picture : flipper.take_released()) ASSERT_EQ(held.erase(picture), 1U) << "released twice: " << picture;
    ASSERT_LE(held.size(), 3U) << "a picture is kept for ever, at step " << step;
    if (!paused && card.picture() != 0) {
      ASSERT_TRUE(held.contains(static_cast<ObjectId>(card.picture()))) << "shown after its release";
    }
  }
  card.fails.clear();
  if (paused) {
    ASSERT_TRUE(flipper.resume());
  }
  card.event_delay_ns = 0;
  for (int i = 0; i < 400; ++i) {
    clock.advance_ns(kPeriod);
    ASSERT_TRUE(flipper.turn());
  }
  EXPECT_EQ(card.picture(), newest);
}

}  // namespace
}  // namespace prismesh::kiosk::display::kms
