// The device's end of a pen's line in a test: a simulated pen behind a pseudo-terminal, and a record of all force frames that it saw.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/port/pty_pair.h"

namespace prismesh::deviced::pen {

struct SeenFrame {
  std::int64_t at_ns = 0;
  drivers::haptic_pen::framed::ForceFrame frame;
  bool of_guard() const { return frame.sender == drivers::haptic_pen::framed::Sender::guard; }
  bool zero() const { return frame.newton.isZero(0); }
};

class PenLine {
 public:
  /// `link` leads to the line, as /dev/serial/by-id does, so that another line can take its place.
  explicit PenLine(std::filesystem::path link, drivers::haptic_pen::HandSource hand) : link_(std::move(link)), hand_(std::move(hand)) {
    plug_in();
  }
  void plug_in() {
    drivers::port::PtyPair pair = drivers::port::open_pty_pair().value();
    std::filesystem::remove(link_);
    std::filesystem::create_symlink(pair.slave_path, link_);
    device_ = std::make_unique<drivers::haptic_pen::framed::SimulatedDeviceThread>(
        std::move(pair.master), drivers::haptic_pen::SimulatedPenOptions{}, hand_,
        [this](std::int64_t at_ns, const drivers::haptic_pen::framed::ForceFrame& frame) {
          const std::lock_guard lock(mutex_);
          seen_.push_back({at_ns, frame});
        });
  }
  void unplug() { device_.reset(); }
  std::vector<SeenFrame> seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }

 private:
  std::filesystem::path link_;
  drivers::haptic_pen::HandSource hand_;
  mutable std::mutex mutex_;
  std::vector<SeenFrame> seen_;
  std::unique_ptr<drivers::haptic_pen::framed::SimulatedDeviceThread> device_;
};

}  // namespace prismesh::deviced::pen
