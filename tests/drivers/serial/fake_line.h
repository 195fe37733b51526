// A USB serial adapter that isn't there: umockdev gives it a place in /sys and /dev, and this class plays the driver's ioctls and the
// device at the far end. Only in a program that runs under umockdev-wrapper.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::drivers::port {

/// What the host has set the line to.
struct LineState {
  int baud = 0;
  bool raw = false;           ///< no echo, no line editing, no translation
  bool eight_n_one = false;   ///< 8 data bits, no parity, 1 stop bit
  bool flow_control = false;  ///< of either kind
  bool dtr = false, rts = false;
  bool exclusive = false;
  std::vector<std::string> unknown_requests;  ///< ioctls that no one here plays
};

class FakeLine {
 public:
  /// Whether the program runs under umockdev-wrapper.
  static bool possible();

  /// Not plugged in yet. Each time it is, it's a ttyUSB of the next number, as a kernel gives them that still holds the last one.
  explicit FakeLine(std::string serial);
  ~FakeLine();
  FakeLine(const FakeLine&) = delete;
  FakeLine& operator=(const FakeLine&) = delete;

  void plug_in();
  void unplug();
  std::string path() const { return "/dev/" + name_; }
  std::string by_id_path() const { return "/dev/serial/by-id/usb-" + serial_ + "-if00-port0"; }

  void say(std::string_view text);
  /// What the host has written; waits up to ten seconds for `length` bytes.
  std::string hear(std::size_t length);
  LineState state() const;

 private:
  struct Testbed;
  std::string name_, serial_;
  int minor_ = 6;
  std::unique_ptr<Testbed> testbed_;
};

}  // namespace prismesh::drivers::port
