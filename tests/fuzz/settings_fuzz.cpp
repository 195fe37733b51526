// Any text as prismesh.toml: either settings whose values lie in their ranges, or an error with a sentence.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/settings/settings.h"

namespace {

using namespace prismesh::drivers::settings;

void demand(bool holds) {
  if (!holds) std::abort();
}

bool is_port(const std::string& port) { return port.empty() || port.front() == '/'; }

void check(const StationSettings& settings) {
  const EyeTrackerSettings& tracker = settings.eye_tracker;
  demand(tracker.driver <= TrackerDriver::opentrack && tracker.dialect <= TrackerDialect::d4d);
  demand(is_port(tracker.port) && tracker.baud >= 300 && tracker.udp_port >= 1);
  demand(tracker.latency_ms >= 0 && tracker.latency_ms <= 500 && tracker.noise_mm >= 0 && tracker.noise_mm <= 50);
  demand(tracker.offset_mm.allFinite() && tracker.eye_separation_mm >= 50 && tracker.eye_separation_mm <= 75 && !tracker.motion.empty());
  const PrismServoSettings& servo = settings.prism_servo;
  demand(servo.driver <= ServoDriver::dynamixel && is_port(servo.port) && servo.baud >= 9600 && servo.id >= 0 && servo.id <= 252);
  demand(servo.travel_mm_per_turn >= 0.1 && servo.travel_mm > 0 && servo.speed_mm_s > 0 && servo.lag_ms >= 0);
  demand(!settings.display.profile.empty());
  demand(tracker.driver != TrackerDriver::dynasight || tracker.simulated || !tracker.port.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto settings = parse_settings({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (settings)
    check(*settings);
  else
    demand(settings.error().file == "fuzz.toml" && settings.error().line >= 1 && !settings.error().message.empty());
  return 0;
}
