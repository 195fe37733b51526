// What the kiosk says to the device daemon, and to one that has been started again.
#include "kiosk/device_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kiosk/listening_daemon.h"

namespace prismesh::kiosk {
namespace {

using testing::ElementsAre;

class DeviceLinkTest : public ListeningDaemonTest {};

TEST_F(DeviceLinkTest, holds_and_releases_once_however_often_it_is_asked) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->release_mask();  // nothing is held
  for (int i = 0; i < 5; ++i) link_->hold_mask(0.25);
  link_->hold_mask(0.5);
  for (int i = 0; i < 5; ++i) link_->release_mask();
  link_->reload();
  ASSERT_TRUE(turn_until_told(4));
  EXPECT_THAT(daemon_->told(), ElementsAre("hold 0.250000", "hold 0.500000", "release", "reload"));
}

TEST_F(DeviceLinkTest, a_daemon_that_is_started_again_holds_the_mask_too) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->hold_mask(0.25);
  ASSERT_TRUE(turn_until_told(1));
  start_daemon_again();
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("hold 0.250000"));
}

TEST_F(DeviceLinkTest, a_mask_that_was_let_go_meanwhile_is_not_held_again) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->hold_mask(0.25);
  ASSERT_TRUE(turn_until_told(1));
  stop_daemon();
  link_->release_mask();
  start_daemon();
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->reload();
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("reload"));
}

TEST_F(DeviceLinkTest, says_what_is_shown_once_and_each_change_of_it) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  for (const bool mono : {true, true, false, false, false, true}) link_->tell_picture(mono);
  ASSERT_TRUE(turn_until_told(3));
  EXPECT_THAT(daemon_->told(), ElementsAre("shows mono", "shows depth", "shows mono"));
}

TEST_F(DeviceLinkTest, a_daemon_that_is_started_again_learns_what_is_shown_now) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->tell_picture(true);
  link_->tell_picture(false);
  ASSERT_TRUE(turn_until_told(2));
  start_daemon_again();
  ASSERT_TRUE(turn_until_told(1)) << "else it parks the mask under a picture in depth";
  EXPECT_THAT(daemon_->told(), ElementsAre("shows depth"));
  stop_daemon();
  link_->tell_picture(true);
  link_->hold_mask(0.25);
  start_daemon();
  ASSERT_TRUE(turn_until_told(2));
  EXPECT_THAT(daemon_->told(), ElementsAre("shows mono", "hold 0.250000"));
}

TEST_F(DeviceLinkTest, a_kiosk_that_has_shown_nothing_says_nothing_about_it) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->reload();
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("reload"));
}

}  // namespace
}  // namespace prismesh::kiosk
