// What clients and deviced say to each other, besides the state page: plain structs, one JSON definition each. Same framing as
// modeld's (one JSON object a line: {"request": "get_devices", "number": 5}). docs/protocol.md describes them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ipc/messages.h"

namespace prismesh::ipc {

inline constexpr int kDeviceProtocolVersion = 1;

// --- requests ---
struct DeviceHello {
  int protocol = kDeviceProtocolVersion;
  std::string program;
};
struct GetDevices {};
struct PictureShown {  ///< no answer: what the kiosk shows has changed from stereo to mono or back
  bool mono = true;
};
struct HoldMask {  ///< calibration: the mask goes there and stays until ReleaseMask or the client's end. One client at a time.
  double position_mm = 0;
};
struct ReleaseMask {};
struct Rearm {};   ///< try again after a stuck mask or a motor's alarm; homes
struct Reload {};  ///< reads settings and profile again: a calibration was saved

using DeviceRequest = std::variant<DeviceHello, GetDevices, PictureShown, HoldMask, ReleaseMask, Rearm, Reload>;

// --- answers (Failed and Done are modeld's) ---
struct DeviceWelcome {  ///< descriptor: the state page
  int protocol = kDeviceProtocolVersion;
  std::string version;
};
/// One device in words.
struct DeviceInfo {
  std::string role;   ///< "eye tracker", "prism servo"
  std::string kind;   ///< "dynasight", "opentrack", "dynamixel"
  std::string where;  ///< its port
  bool simulated = false;
  std::string state;    ///< EyesPhase or MaskPhase, in words
  std::string trouble;  ///< what is wrong, and what to do about it; empty when all is well
  bool operator==(const DeviceInfo&) const = default;
};
struct Devices {
  std::vector<DeviceInfo> devices;
  std::string profile;  ///< the display profile that the mask is moved for
};
using DeviceAnswer = std::variant<Failed, Done, DeviceWelcome, Devices>;

// --- events ---
struct DeviceChanged {  ///< a device came, went or changed its state
  DeviceInfo device;
};
using DeviceEvent = std::variant<DeviceChanged>;

}  // namespace prismesh::ipc
