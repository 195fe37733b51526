#include "drivers/haptic_pen/inverse3/messages.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::drivers::haptic_pen::inverse3 {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kFirstMessage = R"({"session_id":3,"inverse3":[{"device_id":"04BA","config":{"type":"inverse3",
  "device_info":{"major_version":7,"minor_version":1},"handedness":"right","basis":{"permutation":"XYZ"},
  "mount":{"position":{"x":0,"y":0,"z":0},"rotation":{"w":1,"x":0,"y":0,"z":0},"scale":{"x":1,"y":1,"z":1}}},
  "state":{"angular_position":{"a0":-69.3,"a1":137.6,"a2":19.8},"cursor_position":{"x":0.0784,"y":-0.1484,"z":0.143},
  "cursor_velocity":{"x":-0.012,"y":0.0012,"z":-0.0432},"mode":"idle"},
  "status":{"calibrated":false,"in_use":false,"power_supply":true,"ready":true,"started":true}}],
  "wireless_verse_grip":[{"device_id":"61548","state":{"buttons":{"a":true,"b":false,"c":true},"hall":0,
  "orientation":{"x":0.0,"y":0.0,"z":0.6,"w":0.8}},"status":{}}]})";

std::string replaced(std::string_view from, const std::string& what, const std::string& by) {
  std::string text(from);
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Inverse3Messages, are_read) {
  const Result<ServiceState> state = read_message(kFirstMessage);
  ASSERT_TRUE(state) << state.error().text();
  ASSERT_EQ(state->devices.size(), 1u);
  const DeviceState& device = state->devices.front();
  EXPECT_EQ(device.id, "04BA");
  EXPECT_EQ(*device.position_m, Eigen::Vector3d(0.0784, -0.1484, 0.143));
  EXPECT_TRUE(device.ready && device.powered && !device.used_by_another && !device.turned && state->has_session);
  ASSERT_EQ(state->grips.size(), 1u);
  EXPECT_EQ(state->grips.front().buttons, 0b101u);
  EXPECT_TRUE(state->grips.front().orientation->isApprox(Eigen::Quaterniond(0.8, 0, 0, 0.6)));
  EXPECT_EQ(choose_device(*state).value(), "04BA");
}

TEST(Inverse3Messages, may_be_nearly_empty) {
  const Result<ServiceState> state = read_message(R"({"inverse3":[{"device_id":"A"}],"verse_grip":7,"new":[null]})");
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->devices.front().position_m);
  EXPECT_TRUE(state->grips.empty());
  EXPECT_FALSE(state->has_session);
  EXPECT_TRUE(read_message("{}"));
}

TEST(Inverse3Messages, that_cant_be_are_refused_with_a_sentence) {
  for (const auto& [text, sentence] : std::vector<std::pair<std::string, std::string>>{
           {"", "a message isn't JSON"},
           {"hello", "a message isn't JSON"},
           {std::string(kFirstMessage.substr(0, 200)), "a message isn't JSON"},
           {"[1,2]", "a message isn't an object"},
           {std::string(40, '['), "a message is nested too deeply"},
           {std::string(kMaxMessageBytes + 1, ' '), "a message is longer than 64 KiB"},
           {R"({"inverse3":{"049D":{}}})", "\"inverse3\" isn't a list of devices"},
           {R"({"inverse3":[7]})", "a device has no usable \"device_id\""},
           {R"({"inverse3":[{"device_id":"a\"b"}]})", "a device has no usable \"device_id\""},
           {R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":0}}}]})",
            "\"cursor_position\" isn't x, y and z in metres"},
           {R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})", "isn't"},
           {R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":120,"y":0,"z":0}}}]})",
            "\"cursor_position\" isn't x, y and z in metres"}}) {
    const Result<ServiceState> state = read_message(text);
    ASSERT_FALSE(state) << text;
    EXPECT_THAT(state.error().text(), HasSubstr("doesn't talk like a Haply Inverse Service: "));
    EXPECT_THAT(state.error().text(), HasSubstr(sentence));
  }
}

TEST(Inverse3Messages, no_device_is_chosen_that_cant_be_driven) {
  const auto refusal = [](const std::string& text) { return choose_device(read_message(text).value()).error().text(); };
  EXPECT_THAT(refusal("{}"), HasSubstr("knows no Inverse3"));
  EXPECT_THAT(refusal(R"({"inverse3":[{"device_id":"A"},{"device_id":"B"}]})"), HasSubstr("2 Inverse3 are plugged in: leave one"));
  EXPECT_THAT(refusal(replaced(kFirstMessage, "\"in_use\":false", "\"in_use\":true")), HasSubstr("another program uses the Inverse3"));
  EXPECT_THAT(refusal(replaced(kFirstMessage, "\"power_supply\":true", "\"power_supply\":false")), HasSubstr("no power"));
  for (const auto& [was, is] : std::vector<std::pair<std::string, std::string>>{{"\"XYZ\"", "\"XZY\""},
                                                                                {"\"XYZ\"", "7"},
                                                                                {"\"scale\":{\"x\":1", "\"scale\":{\"x\":2"},
                                                                                {"\"w\":1,\"x\":0", "\"w\":0,\"x\":1"},
                                                                                {"\"rotation\":{\"w\":1", "\"rotation\":{\"w\":5"},
                                                                                {"\"position\":{\"x\":0", "\"position\":{\"x\":0.1"}})
    EXPECT_THAT(refusal(replaced(kFirstMessage, was, is)), HasSubstr("set them back")) << is;
}

TEST(Inverse3Messages, set_a_force_that_is_never_longer) {
  EXPECT_EQ(force_message("049D", {1.5, -0.25, 0}, true),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":1.5,"y":-0.25,"z":0}}}}]})");
  EXPECT_EQ(force_message("049D", {0.99999, -0.99999, 1e-9}, false),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":{"x":0.9999,"y":-0.9999,"z":0}}}}]})");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  const std::string zero = force_message("049D", Eigen::Vector3d::Zero(), true);
  EXPECT_EQ(force_message("049D", {1, kNan, 0}, true), zero);
  EXPECT_EQ(force_message("049D", {kInfinite, 1, 0}, true), zero);
  EXPECT_EQ(force_message("049D", {-1e-9, -0.0, 0}, true), zero);
}

TEST(Inverse3Messages, travel_in_one_masked_frame) {
  const auto bytes = [](std::size_t count) { return text_frame(std::string(count, 'a')); };
  const std::vector<std::byte> shortest{std::byte{0x81}, std::byte{0x81}, {}, {}, {}, {}, std::byte{'a'}};
  EXPECT_EQ(bytes(1), shortest);
  EXPECT_EQ(bytes(125).size(), 131u);
  EXPECT_EQ(bytes(125)[1], std::byte{0xFD});
  EXPECT_EQ(bytes(300).size(), 308u);
  EXPECT_EQ(bytes(300)[1], std::byte{0xFE});
  EXPECT_EQ(bytes(300)[2], std::byte{1});
  EXPECT_EQ(bytes(300)[3], std::byte{44});
}

TEST(Inverse3Messages, turn_between_the_axes) {
  // Right stays right, away from the user is against our z, up is our y.
  EXPECT_EQ(to_pen_axes(Eigen::Vector3d(1, 0, 0)), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(to_pen_axes(Eigen::Vector3d(0, 1, 0)), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(to_pen_axes(Eigen::Vector3d(0, 0, 1)), Eigen::Vector3d(0, 1, 0));
  const Eigen::Vector3d any(0.3, -1.2, 2.5);
  EXPECT_EQ(to_service_axes(to_pen_axes(any)), any);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.7, 0.1, -0.5, 0.3).normalized();
  EXPECT_TRUE((to_pen_axes(turn) * to_pen_axes(any)).isApprox(to_pen_axes(Eigen::Vector3d(turn * any)), 1e-12));
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::inverse3
