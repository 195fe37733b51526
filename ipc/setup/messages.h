// What prismesh-setup, the root's side of a station's set-up, is asked and what it answers. One request on a connection. docs/protocol.md
// lists the messages.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/answers.h"

namespace prismesh::ipc {

// --- requests: each one sets one thing, whole or not at all ---
struct GetSetup {};
struct SetName {
  std::string name;  ///< of the station, a host name
};
struct SetNetwork {
  bool dhcp = true;              ///< the rest is empty then
  std::string address;           ///< "192.168.1.20/24" or "fd00::20/64"
  std::string gateway;           ///< empty: none
  std::vector<std::string> dns;  ///< addresses of name servers
};
struct SetProfile {
  std::string profile;  ///< a built-in display profile's name
};
/// A display was calibrated here: its profile becomes the station's, for the kiosk and the device daemon alike.
struct SetCalibration {
  std::string profile;  ///< the text of a profile file
};
/// Whether prismesh-intake serves the network.
struct SetPairing {
  bool on = false;
};
struct SetZone {
  std::string zone;  ///< "Europe/Berlin"
};
/// The station's clock, in its own zone.
struct SetClock {
  std::string date;  ///< "2026-11-28"
  std::string time;  ///< "16:05"
};
/// Where the first set-up goes on after a power cut. Does nothing once that is finished.
struct KeepPage {
  std::string page;  ///< a word
};
/// The kiosk begins with the set-up no more.
struct FinishSetup {};
using SetupRequest =
    std::variant<GetSetup, SetName, SetNetwork, SetProfile, SetCalibration, SetPairing, SetZone, SetClock, KeepPage, FinishSetup>;

// --- answers (Failed and Done: ipc/wire/answers.h). Failed::file is the field that is wrong ---
struct StationSetup {
  bool due = false;  ///< the station was never set up
  std::string page;  ///< where that goes on; empty: at the beginning
  std::string name;
  SetNetwork network;   ///< as it is set
  std::string profile;  ///< that the station's settings name
  bool pairing = false;
  std::string zone;
  std::vector<std::string> zones;  ///< that there are, in order
  bool clock_is_kept = false;      ///< a time server has answered since the start
  std::string date, time;          ///< as SetClock
};
using SetupAnswer = std::variant<Failed, Done, StationSetup>;

}  // namespace prismesh::ipc
