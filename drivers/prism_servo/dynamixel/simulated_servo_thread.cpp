#include "drivers/prism_servo/dynamixel/simulated_servo_thread.h"

#include <chrono>
#include <utility>

namespace prismesh::drivers::prism_servo::dynamixel {

SimulatedServoSettings simulated_servo_settings(const settings::PrismServoSettings& settings) {
  SimulatedServoSettings simulated;
  simulated.id = static_cast<std::uint8_t>(settings.id);
  simulated.travel_mm_per_turn = settings.travel_mm_per_turn;
  simulated.reversed = settings.reversed;
  simulated.zero_ticks = settings.zero_ticks;
  simulated.stop_mm = settings.travel_mm * 1.15;
  simulated.start_mm = settings.travel_mm * 0.3;
  simulated.speed_mm_s = settings.speed_mm_s * 1.2;
  simulated.lag_ms = settings.lag_ms;
  return simulated;
}

SimulatedServoThread::SimulatedServoThread(std::unique_ptr<port::BytePort> device_end, const SimulatedServoSettings& settings)
    : port_(std::move(device_end)), servo_(*port_, settings), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SimulatedServoThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    servo_.jam(jammed_);
    servo_.set_power(powered_);
    servo_.step(clock_.now_ns());
    mask_mm_ = servo_.mask_mm();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace prismesh::drivers::prism_servo::dynamixel
