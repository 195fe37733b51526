// Reads the reports of HID devices through the kernel's hidraw, without a library: a read gives one report, its number first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

struct HidDevice {
  std::string path;  ///< /dev/hidraw3
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;  ///< what the device calls itself
};

/// All HID devices, by path. `classes`: where the kernel lists them; another folder in tests. An entry that can't be read is passed over.
std::vector<HidDevice> list_hid_devices(const std::string& classes = "/sys/class/hidraw");

class HidPort {
 public:
  virtual ~HidPort() = default;
  /// Returns the oldest waiting report, whole; 0 bytes: none. Neither blocks nor allocates. `to` should hold 64 bytes.
  virtual PortCount read(std::span<std::byte> to) = 0;
  /// Becomes readable (poll) when there is a report, or the device is gone.
  virtual int descriptor() const = 0;
  virtual int last_error() const = 0;
};

/// Opens a device for reading, and discards what it had queued. Several programs may read one. Errors, each a sentence: no such device, no
/// permission (names the udev rule).
Result<std::unique_ptr<HidPort>> open_hid_port(const std::string& path, const std::string& name);
/// The same on a descriptor that is open and non-blocking, for tests; it is taken over.
std::unique_ptr<HidPort> hid_port_of(int descriptor);

}  // namespace prismesh::drivers::port
