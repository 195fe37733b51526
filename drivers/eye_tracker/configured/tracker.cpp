#include "drivers/eye_tracker/configured/tracker.h"

#include "base/clock.h"

namespace prismesh::drivers::eye_tracker::configured {

dynasight::DynasightTracker::Options dynasight_options(const settings::EyeTrackerSettings& settings) {
  return {.dialect = settings.dialect,
          .polled = settings.polled,
          .baud = settings.baud,
          .latency_ns = nanoseconds(settings.latency_ms),
          .offset_mm = settings.offset_mm,
          .times = {}};
}

opentrack::OpentrackTracker::Options opentrack_options(const settings::EyeTrackerSettings& settings) {
  opentrack::OpentrackTracker::Options options;
  options.latency_ns = nanoseconds(settings.latency_ms);
  options.offset_mm = settings.offset_mm;
  return options;
}

ConfiguredTracker::ConfiguredTracker(const settings::EyeTrackerSettings& settings)
    : dynasight_(dynasight_options(settings)), opentrack_(opentrack_options(settings)) {}

EyeTracker& ConfiguredTracker::attach(port::BytePort& port) { return tracker_.emplace<dynasight::DynasightTracker>(port, dynasight_); }

EyeTracker& ConfiguredTracker::attach(port::DatagramPort& port) { return tracker_.emplace<opentrack::OpentrackTracker>(port, opentrack_); }

void ConfiguredTracker::detach() { tracker_.emplace<std::monostate>(); }

EyeTracker* ConfiguredTracker::tracker() {
  if (auto* dynasight = std::get_if<dynasight::DynasightTracker>(&tracker_)) return dynasight;
  return std::get_if<opentrack::OpentrackTracker>(&tracker_);
}

}  // namespace prismesh::drivers::eye_tracker::configured
