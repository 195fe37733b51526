// The kiosk's end of the line to the device daemon: connects and connects again, keeps its state page mapped, and knows its devices in
// words. Never waits; looking at the page costs no call.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/reconnecting_client.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/trace.h"

namespace prismesh::kiosk {

class DeviceLink {
 public:
  DeviceLink(const std::filesystem::path& socket, Trace trace);

  /// Connects when it is time to, and reads what has come.
  void turn();
  /// For poll(2); negative while there is no connection.
  int descriptor() const { return client_ != nullptr ? client_->descriptor() : -1; }
  bool connected() const { return client_ != nullptr; }

  /// What the page says now; empty without a daemon.
  stereo::DeviceReading read() const;
  /// What the kiosk shows from now on. Said to each new daemon as well.
  void tell_picture(bool mono);
  /// Try again after a stuck mask or a motor's alarm.
  void rearm();
  /// Calibration: the mask goes there and stays, until it is released or the connection ends.
  void hold_mask(double position_mm);
  void release_mask();
  /// The daemon reads settings and display profile again.
  void reload();
  /// What the daemon has refused since the last call: its words, the newest; empty: nothing.
  std::string take_refusal() { return std::exchange(refusal_, {}); }

  /// Eye tracker and prism servo, as the daemon words them; empty without a daemon.
  const std::vector<ipc::DeviceInfo>& devices() const { return devices_; }
  const ipc::DeviceInfo* device(std::string_view role) const;
  /// Counts up with everything that changes those words.
  std::uint64_t changes() const { return changes_; }

 private:
  void greet();
  void lost(const Error& why);
  void take(const ipc::DeviceAnswer& answer);
  void take(const ipc::DeviceChanged& event);
  template <class Request>
  void send(const Request& request);

  ipc::ReconnectingDeviceClient connection_;
  Trace trace_;
  ipc::DeviceClient* client_ = nullptr;  ///< good until the next turn
  std::size_t greeted_ = 0;              ///< connections that were told what is shown
  std::optional<bool> shown_mono_;
  std::optional<double> held_mm_;
  std::string refusal_;
  std::vector<ipc::DeviceInfo> devices_;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::kiosk
