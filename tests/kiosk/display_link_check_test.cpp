#include "kiosk/display/link_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::kiosk::display {
namespace {

using drivers::display::find_profile;
using drivers::display::Profile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Profile built_in(const char* name) { return *find_profile(name); }

/// A panel of 1920 x 1200 whose link transmits each pixel unchanged.
Monitor good_monitor() {
  Monitor monitor;
  monitor.connector = "DP-1";
  monitor.edid.emplace();
  monitor.edid->identity = {"EIZ", "CG2420", "31337"};
  monitor.edid->digital = true;
  monitor.shown = monitor.mode = monitor.native = {1920, 1200};
  monitor.colour = LinkColour::full;
  return monitor;
}

TEST(LinkCheck, accepts_a_pixel_exact_link) {
  for (const Profile& profile : drivers::display::built_in_profiles()) {
    const LinkReport report = check_link(profile, good_monitor());
    EXPECT_THAT(report.refusals, IsEmpty()) << profile.name;
    EXPECT_THAT(report.doubts, IsEmpty()) << profile.name;
  }
}

TEST(LinkCheck, refuses_a_mode_that_is_not_the_panels) {
  Monitor monitor = good_monitor();
  monitor.shown = monitor.mode = {1680, 1050};
  EXPECT_THAT(check_link(built_in("prism-mask"), monitor).refusals,
              ElementsAre("DP-1 is sent 1680 x 1050 pixels and has 1920 x 1200: set its own resolution"));
}

TEST(LinkCheck, refuses_a_scaled_desktop) {
  Monitor monitor = good_monitor();
  monitor.shown = {3840, 2400};
  EXPECT_THAT(check_link(built_in("prism-mask"), monitor).refusals, ElementsAre(HasSubstr("scaled from 3840 x 2400 to 1920 x 1200")));
  monitor = good_monitor();
  monitor.transformed = true;
  EXPECT_FALSE(check_link(built_in("row-interlaced"), monitor).stereo_allowed());
}

TEST(LinkCheck, refuses_a_turned_picture_once) {
  Monitor monitor = good_monitor();
  monitor.turned = true;
  monitor.shown = {1200, 1920};
  EXPECT_THAT(check_link(built_in("lenticular"), monitor).refusals, ElementsAre(HasSubstr("upright")));
}

TEST(LinkCheck, refuses_halved_colours_and_doubts_unknown_ones) {
  Monitor monitor = good_monitor();
  monitor.colour = LinkColour::halved;
  EXPECT_THAT(check_link(built_in("prism-mask"), monitor).refusals, ElementsAre(HasSubstr("4:2:2")));
  monitor.colour = LinkColour::unknown;
  EXPECT_THAT(check_link(built_in("prism-mask"), monitor).doubts, IsEmpty());  // a monitor that only accepts full colours
  monitor.edid->takes_ycbcr_422 = true;
  EXPECT_THAT(check_link(built_in("prism-mask"), monitor).doubts, ElementsAre(HasSubstr("DP-1")));
  EXPECT_TRUE(check_link(built_in("prism-mask"), monitor).stereo_allowed());
}

TEST(LinkCheck, refuses_another_monitors_calibration) {
  Profile profile = built_in("prism-mask");
  profile.monitor.name = "EIZ CG2420";
  profile.monitor.serial = "31337";
  profile.monitor.pixels = {1920, 1200};
  EXPECT_TRUE(check_link(profile, good_monitor()).stereo_allowed());
  profile.monitor.serial = "4711";
  EXPECT_THAT(check_link(profile, good_monitor()).refusals, ElementsAre(HasSubstr("this is EIZ CG2420 31337: calibrate it here")));
  profile.monitor.serial.clear();
  profile.monitor.pixels = {2560, 1600};
  EXPECT_THAT(check_link(profile, good_monitor()).refusals, ElementsAre(HasSubstr("2560 x 1600")));
}

TEST(LinkCheck, reports_what_it_could_not_determine) {
  EXPECT_THAT(check_link(built_in("prism-mask"), std::nullopt).doubts, ElementsAre(HasSubstr("isn't known")));
  Monitor silent = good_monitor();
  silent.edid.reset();
  silent.native = {};
  silent.colour = LinkColour::unknown;
  const LinkReport report = check_link(built_in("prism-mask"), silent);
  EXPECT_TRUE(report.stereo_allowed());
  EXPECT_EQ(report.doubts.size(), 2u);
}

TEST(LinkCheck, accepts_every_link_for_profiles_that_do_not_weave_pixels) {
  Monitor monitor = good_monitor();
  monitor.shown = monitor.mode = {1280, 800};
  monitor.colour = LinkColour::halved;
  for (const char* name : {"mono", "mono-left", "anaglyph", "side-by-side", "top-bottom"})
    EXPECT_TRUE(check_link(built_in(name), monitor).stereo_allowed()) << name;
}

TEST(LinkCheck, reads_the_names_of_colour_settings) {
  EXPECT_EQ(link_colour_from("YCbCr 4:2:2"), LinkColour::halved);
  EXPECT_EQ(link_colour_from("ycbcr420"), LinkColour::halved);
  EXPECT_EQ(link_colour_from("RGB"), LinkColour::full);
  EXPECT_EQ(link_colour_from("YCBCR444"), LinkColour::full);
  EXPECT_EQ(link_colour_from("auto"), LinkColour::unknown);
}

}  // namespace
}  // namespace prismesh::kiosk::display
