// The messages between deviced and its clients, as plain structs (their JSON: messages_json.cpp). One JSON object on each line, as
// modeld's: {"request": "get_devices", "number": 5}. docs/protocol.md describes them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/answers.h"

namespace prismesh::ipc {

inline constexpr int kDeviceProtocolVersion = 1;

// --- requests ---
struct DeviceHello {
  int protocol = kDeviceProtocolVersion;
  std::string program;
};
struct GetDevices {};
struct PictureShown {  ///< no answer: the kiosk has changed from stereo to mono or back
  bool mono = true;
};
struct HoldMask {  ///< for calibration: moves the mask and holds it until ReleaseMask or the client's end. One client at a time.
  double position_mm = 0;
};
struct ReleaseMask {};
struct Rearm {};   ///< tries again after a stuck mask or a motor's alarm, and homes
struct Reload {};  ///< reads settings and profile again, after a calibration was saved

using DeviceRequest = std::variant<DeviceHello, GetDevices, PictureShown, HoldMask, ReleaseMask, Rearm, Reload>;

// --- answers (Failed and Done: ipc/wire/answers.h) ---
struct DeviceWelcome {  ///< descriptor: the state page
  int protocol = kDeviceProtocolVersion;
  std::string version;
};
/// The state of a device, for people.
struct DeviceInfo {
  std::string role;   ///< "eye tracker", "prism servo"
  std::string kind;   ///< "dynasight", "opentrack", "dynamixel"
  std::string where;  ///< its port
  bool simulated = false;
  std::string state;    ///< EyesPhase or MaskPhase, in words
  std::string trouble;  ///< what is wrong, and what to do about it; empty if nothing is
  bool operator==(const DeviceInfo&) const = default;
};
struct Devices {
  std::vector<DeviceInfo> devices;
  std::string profile;  ///< the display profile in use
};
using DeviceAnswer = std::variant<Failed, Done, DeviceWelcome, Devices>;

// --- events ---
struct DeviceChanged {  ///< a device came, went or changed its state
  DeviceInfo device;
};
using DeviceEvent = std::variant<DeviceChanged>;

}  // namespace prismesh::ipc
