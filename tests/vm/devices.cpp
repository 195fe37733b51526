// The station's devices for a virtual machine: the simulated eye tracker and servo, each as a device on a pseudo-terminal that the machine
// has as a serial port. Prints "tracker PATH" and "servo PATH", then where the mask is, in mm, once a second. Runs until its input ends.
#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "drivers/eye_tracker/configured/simulator.h"
#include "drivers/port/pty_pair.h"
#include "drivers/prism_servo/dynamixel/simulated_servo_thread.h"

int main() {
  using namespace prismesh::drivers;
  prismesh::MonotonicClock clock;
  settings::EyeTrackerSettings head;
  head.driver = settings::TrackerDriver::dynasight;
  head.motion = "still";
  head.noise_mm = 0;
  const auto tracker = eye_tracker::configured::SimulatedTrackerThread::start(head, clock);
  auto line = port::open_pty_pair();
  if (!tracker || !line) {
    std::fprintf(stderr, "%s\n", (tracker ? line.error() : tracker.error()).text().c_str());
    return 1;
  }
  std::printf("tracker %s\nservo %s\n", (*tracker)->port_path().c_str(), line->slave_path.c_str());
  prism_servo::dynamixel::SimulatedServoThread servo(std::move(line->master), prism_servo::dynamixel::simulated_servo_settings({}));
  for (pollfd input{STDIN_FILENO, POLLIN, 0};;) {
    std::fflush(stdout);
    if (::poll(&input, 1, 1000) != 0) {
      char byte = 0;
      if (::read(STDIN_FILENO, &byte, 1) <= 0) return 0;
    }
    std::printf("mask %.4f\n", servo.mask_mm());
  }
}
