#include <random>

#include <gtest/gtest.h>

#include "ipc/device/messages_json.h"
#include "ipc/device/roles.h"

namespace prismesh::ipc {
namespace {

std::string device_refusal(std::string_view line) {
  const auto request = decode_device_request(line);
  return request ? "accepted" : request.error().message;
}

template <class T>
T there_and_back(const DeviceRequest& request) {
  const auto back = decode_device_request(encode_device_request(31, request).value());
  EXPECT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->number, 31u);
  EXPECT_TRUE(std::holds_alternative<T>(back->request));
  return std::get<T>(back->request);
}

template <class T>
T answered(const DeviceAnswer& answer, std::size_t descriptors = 0) {
  const auto back = decode_from_deviced(encode_device_answer(8, answer, descriptors));
  EXPECT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->to, 8u);
  EXPECT_EQ(back->descriptors, descriptors);
  return std::get<T>(std::get<DeviceAnswer>(back->message));
}

TEST(DeviceMessages, requests_survive_a_round_trip) {
  const DeviceHello hello = there_and_back<DeviceHello>(DeviceHello{3, "kiosk"});
  EXPECT_EQ(hello.protocol, 3);
  EXPECT_EQ(hello.program, "kiosk");
  there_and_back<GetDevices>(GetDevices{});
  EXPECT_FALSE(there_and_back<PictureShown>(PictureShown{false}).mono);
  EXPECT_TRUE(there_and_back<PictureShown>(PictureShown{true}).mono);
  EXPECT_EQ(there_and_back<HoldMask>(HoldMask{-1.0 / 3}).position_mm, -1.0 / 3);
  there_and_back<ReleaseMask>(ReleaseMask{});
  there_and_back<Rearm>(Rearm{});
  there_and_back<Reload>(Reload{});
}

TEST(DeviceMessages, answers_and_events_survive_a_round_trip) {
  const DeviceWelcome welcome = answered<DeviceWelcome>(DeviceWelcome{1, "0.1.0"}, 1);
  EXPECT_EQ(welcome.version, "0.1.0");
  answered<Done>(Done{});
  EXPECT_EQ(answered<Failed>(Failed{"prismesh.toml", 4, "no"}).line, 4);

  const DeviceInfo tracker{"eye tracker", "dynasight", "/dev/ttyUSB0", true, "tracking", "none \"at\" all"};
  const Devices devices = answered<Devices>(Devices{{tracker, {}}, "prism-mask"});
  ASSERT_EQ(devices.devices.size(), 2u);
  EXPECT_EQ(devices.profile, "prism-mask");
  EXPECT_EQ(devices.devices[0].role, tracker.role);
  EXPECT_EQ(devices.devices[0].kind, tracker.kind);
  EXPECT_EQ(devices.devices[0].where, tracker.where);
  EXPECT_TRUE(devices.devices[0].simulated);
  EXPECT_EQ(devices.devices[0].state, tracker.state);
  EXPECT_EQ(devices.devices[0].trouble, tracker.trouble);

  const auto event = decode_from_deviced(encode_device_event(DeviceChanged{tracker}));
  ASSERT_TRUE(event) << event.error().text();
  EXPECT_EQ(std::get<DeviceChanged>(std::get<DeviceEvent>(event->message)).device.where, "/dev/ttyUSB0");
}

TEST(DeviceMessages, errors_name_the_field_and_the_nearest_known_one) {
  EXPECT_EQ(device_refusal(R"({"request": "hold_mark"})"), "unknown kind \"hold_mark\"; the nearest is \"hold_mask\"");
  EXPECT_EQ(device_refusal(R"({"request": "hold_mask", "position": 1})"),
            "\"hold_mask\": has no field \"position\"; the nearest is \"position_mm\"");
  EXPECT_EQ(device_refusal(R"({"request": "hold_mask", "position_mm": "left"})"), "\"hold_mask\": field \"position_mm\" must be a number");
  EXPECT_EQ(device_refusal(R"({"request": "hold_mask", "position_mm": 1e999})"), "it isn't JSON");
  EXPECT_EQ(device_refusal(R"({"request": "picture_shown", "mono": 1})"), "\"picture_shown\": field \"mono\" must be true or false");
  EXPECT_EQ(device_refusal(R"({"request": "rearm", "now": true})"), "\"rearm\": has no field \"now\": it has none");
  EXPECT_EQ(device_refusal(R"({"number": 1})"), "field \"request\" is missing");
  EXPECT_EQ(device_refusal(R"({"request": "open", "path": "car.k"})").substr(0, 19), "unknown kind \"open\"")
      << "deviced must not accept modeld's messages";
}

TEST(DeviceMessages, a_newer_daemons_fields_are_passed_over) {
  EXPECT_TRUE(decode_from_deviced(R"({"answer": "devices", "to": 1, "devices": [{"role": "pen", "force": 3}]})"));
}

TEST(DeviceMessages, broken_lines_are_refused_in_words) {
  const std::string sound = encode_device_request(7, HoldMask{0.25}).value();
  std::mt19937 random(3);
  for (int i = 0; i < 20'000; ++i) {
    std::string broken = sound;
    for (unsigned k = random() % 4; k-- > 0;) broken[random() % broken.size()] = static_cast<char>(random());
    if (random() % 3 == 0) broken.resize(random() % broken.size());
    const auto request = decode_device_request(broken);
    if (!request) {
      EXPECT_FALSE(request.error().message.empty());
    }
  }
}

TEST(RolesOfDeviceRequests, are_these) {
  EXPECT_EQ(role_for(DeviceHello{}), Role::watch);
  EXPECT_EQ(role_for(GetDevices{}), Role::watch);
  EXPECT_EQ(role_for(PictureShown{}), Role::devices);
  EXPECT_EQ(role_for(HoldMask{}), Role::devices);
  EXPECT_EQ(role_for(ReleaseMask{}), Role::devices);
  EXPECT_EQ(role_for(Rearm{}), Role::devices);
  EXPECT_EQ(role_for(Reload{}), Role::devices);
  EXPECT_EQ(std::variant_size_v<DeviceRequest>, 7U) << "each is in this test";
}

}  // namespace
}  // namespace prismesh::ipc
