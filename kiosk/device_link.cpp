#include "kiosk/device_link.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk {

DeviceLink::DeviceLink(const std::filesystem::path& socket, notices::Trace trace) : connection_(socket, "prismesh-kiosk"), trace_(trace) {}

void DeviceLink::turn() {
  client_ = connection_.client();
  if (client_ != nullptr && connection_.connections() != greeted_) greet();
  if (client_ == nullptr) return;
  if (const Result<void> polled = client_->poll(); !polled) return lost(polled.error());
  while (const auto reply = client_->next_reply()) take(reply->answer);
  while (const auto event = client_->next_event()) std::visit([this](const auto& what) { take(what); }, *event);
}

void DeviceLink::greet() {
  greeted_ = connection_.connections();
  ++changes_;
  trace_.line("devices connected");
  send(ipc::GetDevices{});
  if (shown_mono_) send(ipc::PictureShown{*shown_mono_});
  if (held_mm_) send(ipc::HoldMask{*held_mm_});
}

template <class Request>
void DeviceLink::send(const Request& request) {
  if (client_ == nullptr) return;
  if (const auto sent = client_->send(request); !sent) lost(sent.error());
}

void DeviceLink::lost(const Error& why) {
  connection_.lost(why);
  client_ = nullptr;
  devices_.clear();
  ++changes_;
  trace_.line("devices disconnected " + why.text());
}

void DeviceLink::take(const ipc::DeviceAnswer& answer) {
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
    refusal_ = failed->message;
    trace_.line("devices refused " + refusal_);
  }
  const auto* all = std::get_if<ipc::Devices>(&answer);
  if (all == nullptr) return;
  devices_ = all->devices;
  ++changes_;
  for (const ipc::DeviceInfo& device : devices_) trace_.line("device " + device.role + ": " + device.state);
}

void DeviceLink::take(const ipc::DeviceChanged& event) {
  const auto known = std::find_if(devices_.begin(), devices_.end(), [&](const ipc::DeviceInfo& d) { return d.role == event.device.role; });
  if (known == devices_.end())
    devices_.push_back(event.device);
  else
    *known = event.device;
  ++changes_;
  trace_.line("device " + event.device.role + ": " + event.device.state);
}

const ipc::DeviceInfo* DeviceLink::device(std::string_view role) const {
  const auto known = std::find_if(devices_.begin(), devices_.end(), [&](const ipc::DeviceInfo& d) { return d.role == role; });
  return known == devices_.end() ? nullptr : &*known;
}

stereo::DeviceReading DeviceLink::read() const {
  if (client_ == nullptr) return {};
  return {client_->page().eyes(), client_->page().prism()};
}

void DeviceLink::tell_picture(bool mono) {
  if (shown_mono_ == mono) return;
  shown_mono_ = mono;
  send(ipc::PictureShown{mono});
}

void DeviceLink::hold_mask(double position_mm) {
  if (held_mm_ == position_mm) return;
  held_mm_ = position_mm;
  send(ipc::HoldMask{position_mm});
}

void DeviceLink::release_mask() {
  if (!std::exchange(held_mm_, std::nullopt)) return;
  send(ipc::ReleaseMask{});
}

void DeviceLink::reload() { send(ipc::Reload{}); }

void DeviceLink::rearm() { send(ipc::Rearm{}); }

}  // namespace prismesh::kiosk
