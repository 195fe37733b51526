#include "kiosk/display/kms/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/display/kms/link.h"
#include "kiosk/display/link_check.h"
#include "tests/kiosk/fake_card.h"

namespace prismesh::kiosk::display::kms {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The first block of an EDID (VESA E-EDID 1.4) whose preferred timing has this size.
std::vector<std::byte> edid_of(int width, int height) {
  std::vector<unsigned> bytes(128, 0);
  for (int i = 1; i < 7; ++i) bytes[static_cast<std::size_t>(i)] = 0xff;
  bytes[8] = 0x15, bytes[9] = 0x3a;    // "EIZ"
  bytes[18] = 1, bytes[19] = 4;        // version
  bytes[20] = 0xa5, bytes[24] = 0x02;  // digital; the first timing is the preferred one
  const auto low = [](int value) { return static_cast<unsigned>(value) & 0xffU; };
  const auto high = [](int value) { return (static_cast<unsigned>(value) >> 8U) << 4U; };
  bytes[54] = 0x28, bytes[55] = 0x3c;  // pixel clock: not a description of text
  bytes[56] = low(width), bytes[58] = high(width);
  bytes[59] = low(height), bytes[61] = high(height);
  unsigned sum = 0;
  for (const unsigned byte : bytes) sum += byte;
  bytes[127] = (256 - sum % 256) % 256;
  std::vector<std::byte> edid;
  for (const unsigned byte : bytes) edid.push_back(static_cast<std::byte>(byte));
  return edid;
}

class Choosing : public testing::Test {
 protected:
  Connector& first() { return card.state().connectors[0]; }
  std::string refusal(const WantedOutput& wanted = {}) {
    const Result<Output> output = choose_output(card.state(), wanted);
    return output ? "nothing refused" : output.error().text();
  }
  PixelSize chosen(const WantedOutput& wanted = {}) {
    const Result<Output> output = choose_output(card.state(), wanted);
    return output ? output->mode.size : PixelSize{};
  }
  std::vector<std::string> notes() { return choose_output(card.state(), {})->notes; }

  ManualClock clock;
  FakeCard card{clock};
};

TEST_F(Choosing, takes_the_mode_that_the_panel_has_by_its_edid) {
  first().edid = edid_of(1024, 768);
  EXPECT_EQ(chosen(), (PixelSize{1024, 768}));
  EXPECT_THAT(notes(), IsEmpty());
}

TEST_F(Choosing, takes_the_preferred_mode_without_an_edid_and_says_so) {
  EXPECT_EQ(chosen(), (PixelSize{1920, 1200}));
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("DP-1 doesn't describe itself (it has no EDID)")));
}

TEST_F(Choosing, takes_the_preferred_mode_when_an_edid_names_one_that_there_isnt) {
  first().edid = edid_of(1680, 1050);
  EXPECT_EQ(chosen(), (PixelSize{1920, 1200}));
  EXPECT_THAT(notes(), ElementsAre("DP-1 says that its panel has 1680x1050 pixels, and the graphics card offers no such mode: 1920x1200 at "
                                   "100.00 Hz is used"));
}

TEST_F(Choosing, an_edid_that_lies_forbids_depth) {
  first().edid = edid_of(1680, 1050);
  const Result<Output> output = choose_output(card.state(), {});
  const Monitor monitor = monitor_of(*output, read_link(card.state(), *output));
  EXPECT_THAT(check_link(*drivers::display::find_profile("prism-mask"), monitor).refusals.front(),
              HasSubstr("is sent 1920 x 1200 pixels and has 1680 x 1050"));
}

TEST_F(Choosing, goes_on_with_a_damaged_edid) {
  first().edid = edid_of(1024, 768);
  first().edid[30] = std::byte{99};
  EXPECT_EQ(chosen(), (PixelSize{1920, 1200}));
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("DP-1: its description of itself (EDID) can't be read")));
}

TEST_F(Choosing, takes_the_mode_of_the_settings) {
  EXPECT_EQ(chosen({"", {1024, 768}, 0}), (PixelSize{1024, 768}));
  EXPECT_EQ(chosen({"DP-1", {1024, 768}, 59.94}), (PixelSize{1024, 768}));
  EXPECT_THAT(refusal({"", {1024, 768}, 75}), HasSubstr("[display] mode: DP-1 offers no 1024x768@75; it offers 1920x1200 at 100.00 Hz, "
                                                        "1024x768 at 60.00 Hz"));
  EXPECT_THAT(refusal({"", {7, 7}, 0}), HasSubstr("DP-1 offers no 7x7;"));
}

TEST_F(Choosing, never_takes_an_interlaced_mode) {
  first().modes = {fake_mode(1920, 1080, 60, true), fake_mode(1280, 720, 60)};
  first().modes[0].interlaced = true;
  EXPECT_EQ(chosen(), (PixelSize{1280, 720}));
}

TEST_F(Choosing, names_what_is_connected) {
  Connector second = card.connector(11, "HDMI-A-1");
  second.connected = false;
  card.state().connectors.push_back(second);
  EXPECT_THAT(refusal({"DP-9", {}, 0}),
              HasSubstr("[display] connector: the graphics card has no \"DP-9\"; it has DP-1, HDMI-A-1 (nothing connected)"));
  EXPECT_THAT(refusal({"HDMI-A-1", {}, 0}), HasSubstr("HDMI-A-1: no monitor is connected there"));
  first().connected = false;
  EXPECT_THAT(refusal(), HasSubstr("no monitor is connected to the graphics card, or all are off"));
  card.state().connectors.clear();
  EXPECT_THAT(refusal(), HasSubstr("(none)"));
}

TEST_F(Choosing, says_which_of_two_monitors_it_takes) {
  card.state().connectors.push_back(card.connector(11, "HDMI-A-1"));
  EXPECT_THAT(notes(), testing::Contains("2 monitors are connected, and DP-1 is used: [display] connector names another"));
  EXPECT_EQ(choose_output(card.state(), {"HDMI-A-1", {}, 0})->connector.id, 11U);
}

TEST_F(Choosing, leaves_a_headset_alone) {
  first().properties["non-desktop"].value = 1;
  EXPECT_THAT(refusal(), HasSubstr("no monitor is connected"));
}

TEST_F(Choosing, refuses_a_monitor_of_one_pixel) {
  first().modes = {fake_mode(1, 1, 60, true)};
  EXPECT_THAT(refusal(), HasSubstr("DP-1: the monitor's mode is 1x1 at 60.00 Hz, and the picture needs at least 320x240 pixels"));
  first().modes.clear();
  EXPECT_THAT(refusal(), HasSubstr("the monitor offers no mode"));
}

TEST_F(Choosing, needs_a_plane_that_shows_pictures) {
  card.state().planes[0].takes_xrgb8888 = false;
  EXPECT_THAT(refusal(), HasSubstr("DP-1: the graphics card has no way to show 24-bit pictures there"));
}

TEST_F(Choosing, reads_back_what_the_driver_has_really_set) {
  const Output output = *choose_output(card.state(), {});
  first().properties["scaling mode"].value = 1;
  first().properties["Broadcast RGB"].value = 2;
  card.state().planes[0].properties["rotation"].value = 4;
  const LinkFacts facts = read_link(card.state(), output);
  EXPECT_THAT(
      facts.differ,
      testing::IsSupersetOf({"DP-1: the graphics card has set its scaling (\"scaling mode\") to Full instead of None",
                             "DP-1: the graphics card has set its colour range (\"Broadcast RGB\") to Limited 16:235 instead of Full"}));
  EXPECT_TRUE(facts.scaled);
  EXPECT_TRUE(facts.turned);
  EXPECT_THAT(facts.not_told, ElementsAre("dithering", "colour format"));
  EXPECT_TRUE(monitor_of(output, facts).transformed);
}

TEST_F(Choosing, knows_colours_at_half_width_from_the_driver) {
  Property format;
  format.id = 999;
  format.names = {{"rgb", 0}, {"ycbcr422", 2}};
  format.value = 2;
  first().properties["color format"] = format;
  const Output output = *choose_output(card.state(), {});
  EXPECT_EQ(read_link(card.state(), output).colour, LinkColour::halved);
}

}  // namespace
}  // namespace prismesh::kiosk::display::kms
