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

ipc::DeviceInfo in_state(std::string role, std::string state) {
  ipc::DeviceInfo device;
  device.role = std::move(role);
  device.state = std::move(state);
  return device;
}

TEST_F(DeviceLinkTest, knows_the_devices_as_the_daemon_words_them_and_forgets_them_with_it) {
  daemon_->have({in_state("eye tracker", "tracking")});
  ASSERT_TRUE(turn_until([&] { return link_->devices().size() == 1; }));
  EXPECT_EQ(link_->device("eye tracker")->state, "tracking");
  EXPECT_EQ(link_->device("prism servo"), nullptr);
  const std::uint64_t before = link_->changes();
  daemon_->change(in_state("eye tracker", "silent"));
  daemon_->change(in_state("prism servo", "homing"));
  link_->reload();
  ASSERT_TRUE(turn_until([&] { return link_->changes() >= before + 3; })) << "an answer and two events";
  ASSERT_EQ(link_->devices().size(), 2u);
  EXPECT_EQ(link_->device("eye tracker")->state, "silent");
  EXPECT_EQ(link_->device("prism servo")->state, "homing");
  stop_daemon();
  EXPECT_TRUE(link_->devices().empty());
  start_daemon();
  daemon_->have({in_state("prism servo", "following")});
  ASSERT_TRUE(turn_until([&] { return !link_->devices().empty(); })) << "the next one is asked";
  EXPECT_EQ(link_->devices().size(), 1u);
}

TEST_F(DeviceLinkTest, what_the_daemon_refuses_is_said_once) {
  daemon_->refuse_holding("the mask is held by calibrate already");
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->hold_mask(0.25);
  std::string refusal;
  ASSERT_TRUE(turn_until([&] { return !(refusal += link_->take_refusal()).empty(); }));
  EXPECT_EQ(refusal, "the mask is held by calibrate already");
  EXPECT_EQ(link_->take_refusal(), "");
}

TEST_F(DeviceLinkTest, rearming_is_told_each_time) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->rearm();
  link_->rearm();
  ASSERT_TRUE(turn_until_told(2));
  EXPECT_THAT(daemon_->told(), ElementsAre("rearm", "rearm"));
}

TEST_F(DeviceLinkTest, a_kiosk_that_has_shown_nothing_says_nothing_about_it) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->reload();
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("reload"));
}

}  // namespace
}  // namespace prismesh::kiosk
