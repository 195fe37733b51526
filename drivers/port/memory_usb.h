// Simulates a USB cable in memory, for tests in virtual time: packets arrive after a delay, and the cable can be unplugged after any byte.
// Reading and writing don't allocate. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/clock.h"
#include "drivers/port/usb_port.h"

namespace prismesh::drivers::port {

/// The device's side: takes what the host sends, and has packets for the host when it asks for one.
class UsbDevice {
 public:
  virtual ~UsbDevice() = default;
  /// Returns false if the device refuses the request.
  virtual bool control(std::int64_t now_ns, const UsbControl& request) = 0;
  virtual void receive(std::int64_t now_ns, std::span<const std::byte> bytes) = 0;
  /// Puts the next packet into `to` (kUsbPacketBytes) and returns its length; 0: there is none now.
  virtual std::size_t send(std::int64_t now_ns, std::span<std::byte> to) = 0;
};

class MemoryUsb {
 public:
  /// Each packet takes `delay_ns` from one side to the other. Both must outlive it and its ports.
  MemoryUsb(Clock& clock, UsbDevice& device, std::int64_t delay_ns = 125'000) : clock_(clock), device_(device), delay_ns_(delay_ns) {}
  MemoryUsb(const MemoryUsb&) = delete;
  MemoryUsb& operator=(const MemoryUsb&) = delete;

  /// The port is `gone` for good after an unplug. It must not outlive the cable.
  std::unique_ptr<UsbPort> open();
  /// Carries what is due: call it as often as packets should be able to move. Ports call it too.
  void run();
  void unplug() { plugged_in_ = false, ++generation_; }
  /// Unplugs after the host has sent so many more bytes of packets: the last packet may reach the device in part.
  void unplug_after_sent(std::size_t bytes) { bytes_left_ = bytes; }
  void plug_in() { plugged_in_ = true; }
  /// Keeps packets of one direction back until it is taken back.
  void hold(bool to_host, bool to_device) { hold_to_host_ = to_host, hold_to_device_ = to_device; }

 private:
  class Port;
  struct Sent {
    std::int64_t due_ns = 0, valid_until_ns = kUsbForever;
    bool is_control = false;
    UsbControl control;
    std::array<std::byte, kUsbPacketBytes> bytes{};
    std::size_t count = 0;
  };
  template <std::size_t Places>
  struct Queue {
    std::array<Sent, Places> places{};
    std::size_t begin = 0, count = 0;
    bool full() const { return count == Places; }
    Sent& front() { return places[begin]; }
    Sent& add() { return places[(begin + count++) % Places]; }
    void drop() { begin = (begin + 1) % Places, --count; }
  };

  Clock& clock_;
  UsbDevice& device_;
  std::int64_t delay_ns_;
  bool plugged_in_ = true, hold_to_host_ = false, hold_to_device_ = false, refused_ = false;
  std::uint64_t generation_ = 0;
  std::optional<std::size_t> bytes_left_;
  std::uint64_t finished_ = 0;
  Queue<kUsbPackets> to_device_, to_host_;
};

}  // namespace prismesh::drivers::port
