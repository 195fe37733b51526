#include "drivers/eye_tracker/configured/simulator.h"

#include <chrono>
#include <functional>
#include <utility>

#include "base/clock.h"
#include "drivers/eye_tracker/dynasight/simulator.h"
#include "drivers/eye_tracker/head_motion.h"
#include "drivers/eye_tracker/opentrack/simulator.h"
#include "drivers/port/pty_pair.h"
#include "drivers/port/udp_port.h"

namespace prismesh::drivers::eye_tracker::configured {
namespace {

constexpr auto kStep = std::chrono::milliseconds(1);

HeadSource source_of(const HeadMotion& motion) {
  return [motion](double seconds) { return SimulatedHead{.between_eyes_mm = motion.between_eyes_mm(seconds)}; };
}

std::unique_ptr<TrackerSimulator> play_dynasight(port::BytePort& line, const HeadMotion& motion,
                                                 const settings::EyeTrackerSettings& settings, std::uint64_t seed) {
  dynasight::DynasightSimulator::Options options;
  options.dialect = settings.dialect;
  options.baud = settings.baud;
  options.noise_mm = settings.noise_mm;
  options.latency_ns = nanoseconds(settings.latency_ms);
  options.offset_mm = settings.offset_mm;
  options.seed = seed;
  return std::make_unique<dynasight::DynasightSimulator>(line, source_of(motion), options);
}

std::unique_ptr<TrackerSimulator> play_opentrack(port::UdpSender& sender, const HeadMotion& motion,
                                                 const settings::EyeTrackerSettings& settings, std::uint64_t seed) {
  opentrack::OpentrackSimulator::Options options;
  options.noise_mm = settings.noise_mm;
  options.latency_ns = nanoseconds(settings.latency_ms);
  options.offset_mm = settings.offset_mm;
  options.seed = seed;
  return std::make_unique<opentrack::OpentrackSimulator>([&sender](std::span<const std::byte> datagram) { sender.send(datagram); },
                                                         source_of(motion), options);
}

}  // namespace

struct SimulatedTrackerThread::Device {
  port::PtyPair terminal;
  std::unique_ptr<port::UdpSender> sender;
  std::unique_ptr<TrackerSimulator> simulator;
};

Result<std::unique_ptr<SimulatedTrackerThread>> SimulatedTrackerThread::start(const settings::EyeTrackerSettings& settings, Clock& clock,
                                                                              std::uint64_t seed) {
  const auto kind = motion_kind_from(settings.motion);
  if (!kind) return fail(kind.error());
  const HeadMotion motion(*kind, seed);
  auto device = std::make_unique<Device>();
  if (settings.driver == settings::TrackerDriver::dynasight) {
    auto terminal = port::open_pty_pair();
    if (!terminal) return fail(terminal.error());
    device->terminal = std::move(*terminal);
    device->simulator = play_dynasight(*device->terminal.master, motion, settings, seed);
  } else if (settings.driver == settings::TrackerDriver::opentrack) {
    auto sender = port::UdpSender::open(settings.udp_port);
    if (!sender) return fail(sender.error());
    device->sender = std::move(*sender);
    device->simulator = play_opentrack(*device->sender, motion, settings, seed);
  } else {
    return fail("eye tracker",
                "there is nothing to simulate: the settings name no driver; set eye_tracker.driver to dynasight or opentrack");
  }
  std::unique_ptr<SimulatedTrackerThread> thread(new SimulatedTrackerThread);
  thread->device_ = std::move(device);
  thread->port_path_ = thread->device_->terminal.slave_path;
  thread->thread_ = std::jthread([simulator = thread->device_->simulator.get(), &clock](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      simulator->run_until(clock.now_ns());
      std::this_thread::sleep_for(kStep);
    }
  });
  return thread;
}

SimulatedTrackerThread::~SimulatedTrackerThread() = default;

}  // namespace prismesh::drivers::eye_tracker::configured
