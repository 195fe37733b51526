// Simulated USB devices for the real libusb: umockdev adds them to /sys and /dev, and this class handles the kernel's side of their ioctls.
// Works only in a program that runs under umockdev-wrapper, and in programs that it starts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/port/memory_usb.h"

namespace prismesh::drivers::port {

struct FakeUsbOptions {
  std::uint16_t vendor = 0x0403;
  std::uint16_t product = 0xCB48;
  std::string product_text = "FALCON HAPTIC";
  std::uint8_t out_endpoint = 0x02;
  std::uint8_t in_endpoint = 0x81;
};

/// One bus.
class FakeUsb {
 public:
  static bool possible();

  FakeUsb();
  ~FakeUsb();
  FakeUsb(const FakeUsb&) = delete;
  FakeUsb& operator=(const FakeUsb&) = delete;

  /// Plugs a device in; returns its number on the bus. `device` is called by umockdev's thread, until it is unplugged, with
  /// CLOCK_MONOTONIC.
  int plug_in(UsbDevice& device, const FakeUsbOptions& options = {});
  void unplug(int number);
  /// Another program has claimed it.
  void claim_by_another(int number, bool claimed);
  std::string path(int number) const;

 private:
  struct Bus;
  std::unique_ptr<Bus> bus_;
};

}  // namespace prismesh::drivers::port
