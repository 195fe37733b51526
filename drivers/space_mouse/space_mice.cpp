#include "drivers/space_mouse/space_mice.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace prismesh::drivers::space_mouse {

SpaceMouseSources system_sources() {
  return {[] { return port::list_hid_devices(); },
          [](const std::string& path, const std::string& name) { return port::open_hid_port(path, name); },
          [] { return connect_to_spnav(spnav_socket_path()); }};
}

SpaceMice::SpaceMice(Clock& clock, SpaceMouseSources sources, const SpaceMouseResponse& response)
    : clock_(clock), sources_(std::move(sources)), response_(response), next_look_ns_(clock.now_ns()) {}

void SpaceMice::turn() {
  if (clock_.now_ns() >= next_look_ns_) {
    next_look_ns_ = clock_.now_ns() + kLookNs;
    look();
  }
  changes_ += std::erase_if(devices_, [&](Device& device) { return !read(device); });
  add_up();
}

void SpaceMice::look() {
  const std::string trouble_before = std::exchange(trouble_, {});
  if (connect()) {
    refused_.clear();
  } else {
    std::map<std::string, int> refused_before = std::exchange(refused_, {});
    for (const port::HidDevice& found : sources_.list()) {
      const auto model = find_space_mouse(found.vendor, found.product);
      if (!model || std::any_of(devices_.begin(), devices_.end(), [&](const Device& each) { return each.path == found.path; })) continue;
      refused_[found.path] = refused_before[found.path];
      open(found, std::string(model->name));
    }
  }
  if (trouble_ != trouble_before) ++changes_;
}

/// Whether spacenavd is there; then no other device is.
bool SpaceMice::connect() {
  if (std::any_of(devices_.begin(), devices_.end(), [](const Device& each) { return each.spnav; })) return true;
  auto stream = sources_.connect();
  if (!stream) return false;
  devices_.clear();
  Device& device = devices_.emplace_back();
  device.name = "spacenavd";
  device.port = std::move(*stream);
  device.spnav = true;
  ++changes_;
  return true;
}

void SpaceMice::open(const port::HidDevice& found, const std::string& name) {
  auto opened = sources_.open(found.path, name);
  if (!opened) {
    if (++refused_[found.path] >= 2 && trouble_.empty()) trouble_ = opened.error().text();
    return;
  }
  Device& device = devices_.emplace_back();
  device.path = found.path;
  device.name = name;
  device.port = std::move(*opened);
  ++changes_;
}

/// False: the device is gone.
bool SpaceMice::read(Device& device) {
  std::array<std::byte, 64> bytes{};
  for (int i = 0; i < kMostReports; ++i) {
    const port::PortCount got = device.port->read(bytes);
    if (got.status == port::PortStatus::gone) return false;
    if (got.bytes == 0) return true;
    const auto report = std::span(bytes).first(got.bytes);
    std::uint64_t before = device.state.buttons;
    if (device.spnav) {
      device.events.take(report, device.state, [&](const SpaceMouseState& now) { pressed(std::exchange(before, now.buttons), now); });
    } else if (take_report(report, device.state)) {
      pressed(before, device.state);
    }
  }
  return true;
}

void SpaceMice::add_up() {
  motion_ = {};
  if (!listens_) {
    presses_ = 0;
    return;
  }
  for (const Device& device : devices_) {
    const SpaceMouseMotion its = motion_of(device.state, response_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion_.shift[axis] = std::clamp(motion_.shift[axis] + its.shift[axis], -1.0, 1.0);
      motion_.turn[axis] = std::clamp(motion_.turn[axis] + its.turn[axis], -1.0, 1.0);
    }
  }
}

std::string SpaceMice::names() const {
  std::string names;
  for (const Device& device : devices_) names += (names.empty() ? "" : ", ") + device.name;
  return names;
}

std::vector<int> SpaceMice::descriptors() const {
  std::vector<int> descriptors;
  for (const Device& device : devices_) descriptors.push_back(device.port->descriptor());
  return descriptors;
}

}  // namespace prismesh::drivers::space_mouse
