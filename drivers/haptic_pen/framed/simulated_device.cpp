#include "drivers/haptic_pen/framed/simulated_device.h"

#include <pthread.h>
#include <sched.h>

#include <chrono>
#include <cmath>
#include <utility>

namespace prismesh::drivers::haptic_pen::framed {
namespace {

constexpr std::int64_t kPosePeriodNs = 1'000'000;

}  // namespace

SimulatedDevice::SimulatedDevice(port::BytePort& line, const SimulatedPenOptions& options, HandSource hand, ForceWatcher watcher)
    : line_(line), pen_(options, std::move(hand)), watcher_(std::move(watcher)), quantum_mm_(options.quantum_mm) {}

void SimulatedDevice::step(std::int64_t now_ns) {
  for (;;) {
    const port::PortCount got = line_.read(finder_.space());
    finder_.received(got.bytes);
    while (const auto bytes = finder_.next()) {
      const auto frame = decode_force(*bytes);
      if (!frame) continue;
      answers_ = frame->number;
      if (watcher_) watcher_(now_ns, *frame);
      pen_.send(now_ns, {frame->newton, now_ns + frame->valid_ms * std::int64_t{1'000'000}});
    }
    if (got.bytes == 0) break;
  }
  (void)pen_.read(now_ns);  // moves the pen up to now; its answers come as frames instead
  if (now_ns < pose_due_ns_) return;
  // After a stall there is one pose, not one for each millisecond that passed.
  pose_due_ns_ = pose_due_ns_ == 0 || now_ns - pose_due_ns_ > kPosePeriodNs ? now_ns + kPosePeriodNs : pose_due_ns_ + kPosePeriodNs;
  PoseFrame pose;
  pose.number = ++number_;
  for (int axis = 0; axis < 3; ++axis) {
    const double mm = pen_.position_mm()[axis];
    pose.position_mm[axis] = quantum_mm_ > 0 ? std::round(mm / quantum_mm_) * quantum_mm_ : mm;
  }
  pose.phase = PenPhase::ready;
  pose.buttons = static_cast<std::uint8_t>(pen_.buttons());
  pose.answers = answers_;
  const FrameBytes bytes = encode(pose);
  (void)line_.write(bytes);  // a host that reads nothing loses poses
}

PenLimits simulated_limits(const SimulatedPenOptions& options) {
  PenLimits limits = SimulatedPen(options, wandering_hand).limits();
  limits.delay_ns += kPosePeriodNs;  // a pose waits for its millisecond
  return limits;
}

SimulatedHand wandering_hand(double seconds) {
  SimulatedHand hand;
  hand.goal_mm = {25 * std::sin(0.9 * seconds), 15 * std::sin(1.3 * seconds), 20 * std::cos(0.7 * seconds)};
  return hand;
}

SimulatedDeviceThread::SimulatedDeviceThread(std::unique_ptr<port::BytePort> device_end, const SimulatedPenOptions& options,
                                             HandSource hand, ForceWatcher watcher)
    : port_(std::move(device_end)),
      device_(*port_, options, std::move(hand), std::move(watcher)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SimulatedDeviceThread::run(const std::stop_token& stop) {
  // A device doesn't wait for this machine's other programs. Where this isn't granted, the simulated one has to.
  const sched_param lowest{.sched_priority = ::sched_get_priority_min(SCHED_FIFO)};
  (void)::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &lowest);
  while (!stop.stop_requested()) {
    device_.step(clock_.now_ns());
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

}  // namespace prismesh::drivers::haptic_pen::framed
