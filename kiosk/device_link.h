// The kiosk's connection to the device daemon: connects again when it is lost, keeps the state page mapped, and words the devices. Never
// waits; reading the page costs no call.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/device/client.h"
#include "kiosk/notices/trace.h"
#include "kiosk/stereo/tracked_eyes.h"

namespace prismesh::kiosk {

class DeviceLink {
 public:
  DeviceLink(const std::filesystem::path& socket, notices::Trace trace);

  /// Connects when it is time to, and reads what has arrived.
  void turn();
  /// For poll(2); negative while there is no connection.
  int descriptor() const { return client_ != nullptr ? client_->descriptor() : -1; }
  bool connected() const { return client_ != nullptr; }

  /// The page as it is now; empty without a daemon.
  stereo::DeviceReading read() const;
  /// Tells the daemon what the kiosk shows from now on. Each new daemon is told too.
  void tell_picture(bool mono);
  /// Asks for another try after a stuck mask or a motor's alarm.
  void rearm();
  /// Calibration: moves the mask there and holds it, until it is released or the connection ends.
  void hold_mask(double position_mm);
  void release_mask();
  /// Asks the daemon to read settings and display profile again.
  void reload();
  /// The newest refusal since the last call, in the daemon's words; empty: none.
  std::string take_refusal() { return std::exchange(refusal_, {}); }

  /// Eye tracker and prism servo, as the daemon words them; empty without a daemon.
  const std::vector<ipc::DeviceInfo>& devices() const { return devices_; }
  const ipc::DeviceInfo* device(std::string_view role) const;
  /// Counts up with each change of those words.
  std::uint64_t changes() const { return changes_; }

 private:
  void greet();
  void lost(const Error& why);
  void take(const ipc::DeviceAnswer& answer);
  void take(const ipc::DeviceChanged& event);
  template <class Request>
  void send(const Request& request);

  ipc::ReconnectingDeviceClient connection_;
  notices::Trace trace_;
  ipc::DeviceClient* client_ = nullptr;  ///< good until the next turn
  std::size_t greeted_ = 0;              ///< connections that were told what is shown
  std::optional<bool> shown_mono_;
  std::optional<double> held_mm_;
  std::string refusal_;
  std::vector<ipc::DeviceInfo> devices_;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::kiosk
