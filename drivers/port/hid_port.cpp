#include "drivers/port/hid_port.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "drivers/port/open_error.h"

namespace prismesh::drivers::port {
namespace {

std::optional<std::uint16_t> hex_number(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size() || value > 0xFFFF) return std::nullopt;
  return static_cast<std::uint16_t>(value);
}

/// From the lines of a device's `uevent`: HID_ID=0003:0000046D:0000C626, HID_NAME=..
std::optional<HidDevice> described_by(std::istream& lines) {
  HidDevice device;
  bool known = false;
  for (std::string line; std::getline(lines, line);) {
    const std::string_view text = line;
    if (text.starts_with("HID_NAME=")) device.name = text.substr(9);
    if (!text.starts_with("HID_ID=")) continue;
    const std::size_t first = text.find(':'), second = first == text.npos ? text.npos : text.find(':', first + 1);
    if (second == text.npos) return std::nullopt;
    const auto vendor = hex_number(text.substr(first + 1, second - first - 1)), product = hex_number(text.substr(second + 1));
    if (!vendor || !product) return std::nullopt;
    device.vendor = *vendor;
    device.product = *product;
    known = true;
  }
  if (!known) return std::nullopt;
  return device;
}

class DescriptorHidPort final : public HidPort {
 public:
  explicit DescriptorHidPort(int descriptor) : descriptor_(descriptor) {}
  ~DescriptorHidPort() override { ::close(descriptor_); }
  DescriptorHidPort(const DescriptorHidPort&) = delete;
  DescriptorHidPort& operator=(const DescriptorHidPort&) = delete;

  PortCount read(std::span<std::byte> to) override {
    if (gone_) return {0, PortStatus::gone};
    const ssize_t got = ::read(descriptor_, to.data(), to.size());
    if (got > 0) return {static_cast<std::size_t>(got), PortStatus::ok};
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return {};
    last_error_ = got < 0 ? errno : 0;
    gone_ = true;
    return {0, PortStatus::gone};
  }
  int descriptor() const override { return descriptor_; }
  int last_error() const override { return last_error_; }

 private:
  int descriptor_;
  bool gone_ = false;
  int last_error_ = 0;
};

}  // namespace

std::vector<HidDevice> list_hid_devices(const std::string& classes) {
  std::vector<HidDevice> devices;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(classes, ignored), end; !ignored && entry != end; entry.increment(ignored)) {
    std::ifstream lines(entry->path() / "device" / "uevent");
    auto device = described_by(lines);
    if (!device) continue;
    device->path = "/dev/" + entry->path().filename().string();
    devices.push_back(std::move(*device));
  }
  std::sort(devices.begin(), devices.end(), [](const HidDevice& a, const HidDevice& b) { return a.path < b.path; });
  return devices;
}

Result<std::unique_ptr<HidPort>> open_hid_port(const std::string& path, const std::string& name) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return fail(usb_open_error(name, path, errno));
  std::unique_ptr<HidPort> port = hid_port_of(descriptor);
  std::array<std::byte, 64> old{};
  // The kernel queues 64 reports at most; a device that sends without end doesn't hold this up.
  for (int i = 0; i < 64; ++i) {
    const PortCount got = port->read(old);
    if (got.status == PortStatus::gone) return fail(usb_open_error(name, path, port->last_error() != 0 ? port->last_error() : EIO));
    if (got.bytes == 0) break;
  }
  return port;
}

std::unique_ptr<HidPort> hid_port_of(int descriptor) { return std::make_unique<DescriptorHidPort>(descriptor); }

}  // namespace prismesh::drivers::port
