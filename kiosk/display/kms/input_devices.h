// The input devices of a seat, as they are plugged in and out (libinput).
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "kiosk/display/kms/input.h"
#include "kiosk/display/kms/seat.h"

struct libinput;
struct udev;

namespace prismesh::kiosk::display::kms {

class InputDevices {
 public:
  using Tell = std::function<void(const std::string&)>;
  /// Finds the seat's devices. Having none is no error: they may come later. `tell` gets a sentence for each that can't be used.
  static Result<std::unique_ptr<InputDevices>> open(Seat& seat, Tell tell);
  ~InputDevices();
  InputDevices(const InputDevices&) = delete;
  InputDevices& operator=(const InputDevices&) = delete;

  /// Takes what they have done into `input`.
  void turn(Input& input);
  /// For poll(2).
  int descriptor() const;
  /// The seat is lost, and ours again.
  void suspend();
  void resume();

 private:
  InputDevices(Seat& seat, Tell tell) : seat_(seat), tell_(std::move(tell)) {}

  Seat& seat_;
  Tell tell_;
  udev* udev_ = nullptr;
  libinput* devices_ = nullptr;
};

}  // namespace prismesh::kiosk::display::kms
