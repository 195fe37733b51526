// A haptic pen that a test moves: the device's end of a line of frames (docs/haptics.md), behind a pseudo-terminal. It feels no force.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "drivers/haptic_pen/framed/frame.h"
#include "drivers/port/pty_pair.h"

namespace prismesh::test {

class ScriptedPen {
 public:
  static constexpr std::uint8_t kFirst = 1, kSecond = 2;

  /// `link` leads to the line, so that another line can take its place.
  explicit ScriptedPen(std::filesystem::path link) : link_(std::move(link)) { plug_in(); }

  void plug_in() {
    drivers::port::PtyPair pair = drivers::port::open_pty_pair().value();
    std::filesystem::remove(link_);
    std::filesystem::create_symlink(pair.slave_path, link_);
    line_ = std::move(pair.master);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  void unplug() {
    thread_ = {};
    line_.reset();
  }
  /// Moves at 300 mm/s; returns once the pose has been sent for a while.
  void move_to(const Eigen::Vector3d& mm) {
    {
      const std::lock_guard lock(mutex_);
      goal_mm_ = mm;
    }
    for (bool there = false; !there; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
      const std::lock_guard lock(mutex_);
      there = at_mm_ == goal_mm_;
    }
  }
  void buttons(std::uint8_t down) {
    {
      const std::lock_guard lock(mutex_);
      buttons_ = down;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  }

 private:
  void run(const std::stop_token& stop) {
    using namespace drivers::haptic_pen;
    while (!stop.stop_requested()) {
      for (;;) {
        const drivers::port::PortCount got = line_->read(finder_.space());
        finder_.received(got.bytes);
        while (const auto bytes = finder_.next())
          if (const auto force = framed::decode_force(*bytes)) answers_ = force->number;
        if (got.bytes == 0) break;
      }
      framed::PoseFrame pose;
      {
        const std::lock_guard lock(mutex_);
        const Eigen::Vector3d way = goal_mm_ - at_mm_;
        at_mm_ = way.norm() > kStepMm ? Eigen::Vector3d(at_mm_ + way.normalized() * kStepMm) : goal_mm_;
        pose.position_mm = at_mm_;
        pose.buttons = buttons_;
      }
      pose.number = ++number_;
      pose.phase = PenPhase::ready;
      pose.answers = answers_;
      (void)line_->write(framed::encode(pose));  // nobody may listen
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  static constexpr double kStepMm = 0.3;  ///< a millisecond
  std::filesystem::path link_;
  std::mutex mutex_;  ///< of the next three
  Eigen::Vector3d at_mm_ = Eigen::Vector3d::Zero(), goal_mm_ = Eigen::Vector3d::Zero();
  std::uint8_t buttons_ = 0;
  std::uint8_t number_ = 0, answers_ = 0;
  drivers::haptic_pen::framed::FrameFinder finder_;
  std::unique_ptr<drivers::port::BytePort> line_;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace prismesh::test
