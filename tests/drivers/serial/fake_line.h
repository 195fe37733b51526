// A simulated USB serial adapter: umockdev adds it to /sys and /dev, and this class handles the driver's ioctls and acts as the device at
// the other end. Works only in a program that runs under umockdev-wrapper.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::drivers::port {

/// The line settings that the host has made.
struct LineState {
  int baud = 0;
  bool raw = false;           ///< no echo, no line editing, no translation
  bool eight_n_one = false;   ///< 8 data bits, no parity, 1 stop bit
  bool flow_control = false;  ///< hardware or software
  bool dtr = false, rts = false;
  bool exclusive = false;
  std::vector<std::string> unknown_requests;  ///< ioctls that this class doesn't handle
};

class FakeLine {
 public:
  /// Whether the program runs under umockdev-wrapper.
  static bool possible();

  /// Not plugged in at first. Each time it is plugged in it gets the next ttyUSB number, as from a kernel that still holds the previous
  /// one.
  explicit FakeLine(std::string serial);
  ~FakeLine();
  FakeLine(const FakeLine&) = delete;
  FakeLine& operator=(const FakeLine&) = delete;

  void plug_in();
  void unplug();
  std::string path() const { return "/dev/" + name_; }
  std::string by_id_path() const { return "/dev/serial/by-id/usb-" + serial_ + "-if00-port0"; }

  void send(std::string_view text);
  /// Returns what the host has written; waits up to ten seconds for `length` bytes.
  std::string receive(std::size_t length);
  LineState state() const;

 private:
  struct Testbed;
  std::string name_, serial_;
  int minor_ = 6;
  std::unique_ptr<Testbed> testbed_;
};

}  // namespace prismesh::drivers::port
