#include "daemon/deviced/station.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "daemon/deviced/loop_thread.h"
#include "drivers/eye_tracker/configured/simulator.h"
#include "drivers/port/keeper_thread.h"
#include "drivers/port/open_port.h"
#include "drivers/port/pty_pair.h"
#include "drivers/port/udp_port.h"
#include "drivers/prism_servo/dynamixel/simulated_servo_thread.h"

namespace prismesh::deviced {

namespace {

using drivers::eye_tracker::configured::SimulatedTrackerThread;
using drivers::port::BytePort;
using drivers::port::DatagramKeeper;
using drivers::port::DatagramPort;
using drivers::port::KeeperReport;
using drivers::port::PortKeeper;
using drivers::prism_servo::dynamixel::SimulatedServoThread;
using drivers::settings::TrackerDriver;

/// Records count as missing after so long: five at 60 Hz.
constexpr std::int64_t kMissedNs = 80'000'000;

PortKeeper::Maker line(const std::string& path, int baud) {
  return [path, baud] { return drivers::port::open_port(path, baud); };
}

DatagramKeeper::Maker datagrams(std::uint16_t udp_port) {
  return [udp_port]() -> Result<std::unique_ptr<DatagramPort>> {
    return drivers::port::UdpPort::open(udp_port).map([](auto port) { return std::unique_ptr<DatagramPort>(std::move(port)); });
  };
}

}  // namespace

bool StationPlan::same_devices(const StationPlan& other) const {
  return settings.eye_tracker == other.settings.eye_tracker && settings.prism_servo == other.settings.prism_servo &&
         profile.mask_moves == other.profile.mask_moves;
}

Result<StationPlan> read_plan(const std::optional<std::filesystem::path>& config) {
  Result<drivers::settings::StationSettings> settings = drivers::settings::read_settings(config);
  if (!settings) return fail(std::move(settings.error()));
  Result<drivers::display::Profile> profile = drivers::display::find_profile(settings->display.profile);
  if (!profile) return fail(std::move(profile.error()));
  StationPlan plan{std::move(*settings), std::move(*profile), {}};
  if (!plan.has_servo()) return plan;
  Result<drivers::prism_servo::dynamixel::ServoSettings> servo = drivers::prism_servo::dynamixel::servo_settings(plan.settings.prism_servo);
  if (!servo) return fail(std::move(servo.error()));
  plan.servo = *servo;
  return plan;
}

LoopSettings loop_settings(const StationPlan& plan) {
  LoopSettings settings;
  settings.tracker = plan.settings.eye_tracker;
  settings.servo = plan.servo;
  settings.optics = plan.profile.optics;
  settings.limits.travel_mm = plan.settings.prism_servo.travel_mm;
  settings.limits.speed_mm_s = plan.settings.prism_servo.speed_mm_s;
  // A slow tracker's samples, for example a webcam's, are already old when they arrive.
  const std::int64_t latency_ns = nanoseconds(plan.settings.eye_tracker.latency_ms);
  settings.limits.eyes_lost_ns = std::max(settings.limits.eyes_lost_ns, latency_ns + kMissedNs);
  settings.eye_separation_mm = plan.eye_separation_mm();
  return settings;
}

/// A loop that hasn't ticked for 1.5 s hangs. The devices have stopped by their own watchdogs by then.
constexpr std::chrono::milliseconds kWatchPeriod{250};
constexpr int kMaxMissedBeats = 6;

/// Members stand in the order of their construction; they end in reverse: watchdog, loop, keepers, simulators.
struct Station::Impl {
  explicit Impl(StationPlan wanted) : plan(std::move(wanted)) {}

  StationPlan plan;
  MonotonicClock clock;
  std::unique_ptr<SimulatedTrackerThread> simulated_tracker;
  std::unique_ptr<SimulatedServoThread> simulated_servo;
  std::optional<PortKeeper> tracker_line;
  std::optional<DatagramKeeper> tracker_datagrams;
  std::optional<PortKeeper> servo_line;
  std::optional<DeviceLoop> loop;
  std::optional<drivers::port::KeeperThread> keeper_thread;
  std::unique_ptr<LoopThread> loop_thread;
  std::optional<daemon::Watchdog> watchdog;

  EyesChanged eyes;
  ServoStatus servo;

  Result<void> start_simulators() {
    auto& tracker = plan.settings.eye_tracker;
    if (plan.has_tracker() && tracker.simulated) {
      auto started = SimulatedTrackerThread::start(tracker, clock);
      if (!started) return fail(std::move(started.error()));
      simulated_tracker = std::move(*started);
      tracker.port = simulated_tracker->port_path();
    }
    auto& motor = plan.settings.prism_servo;
    if (plan.has_servo() && motor.simulated) {
      auto terminal = drivers::port::open_pty_pair();
      if (!terminal) return fail(std::move(terminal.error()));
      motor.port = terminal->slave_path;
      simulated_servo = std::make_unique<SimulatedServoThread>(std::move(terminal->master),
                                                               drivers::prism_servo::dynamixel::simulated_servo_settings(motor));
    }
    return {};
  }

  void make_keepers() {
    const auto& tracker = plan.settings.eye_tracker;
    if (tracker.driver == TrackerDriver::dynasight) tracker_line.emplace(clock, line(tracker.port, tracker.baud), tracker.port);
    if (tracker.driver == TrackerDriver::opentrack) tracker_datagrams.emplace(clock, datagrams(tracker.udp_port));
    const auto& motor = plan.settings.prism_servo;
    if (plan.has_servo()) servo_line.emplace(clock, line(motor.port, motor.baud), motor.port);
  }

  Result<void> start_loop(ipc::DevicePage& page, bool memory_locked, std::function<void()> stuck) {
    LoopPorts ports;
    std::vector<drivers::port::KeeperWork> work;
    const auto keep = [&work](auto& keeper, auto*& port) {
      if (!keeper) return;
      port = &*keeper;
      work.push_back(drivers::port::work_of(*keeper));
    };
    keep(tracker_line, ports.tracker_line);
    keep(tracker_datagrams, ports.tracker_datagrams);
    keep(servo_line, ports.servo_line);
    loop.emplace(loop_settings(plan), ports, page);
    keeper_thread.emplace(clock, std::move(work));
    Result<std::unique_ptr<LoopThread>> started = LoopThread::start(*loop, page, memory_locked, simulated_tracker || simulated_servo);
    if (!started) return fail(std::move(started.error()));
    loop_thread = std::move(*started);
    std::vector<daemon::HeartbeatMonitor> watched;
    watched.emplace_back("the device loop hangs", loop_thread->heartbeat(), kMaxMissedBeats);
    watchdog.emplace(std::move(watched), kWatchPeriod, [stuck = std::move(stuck)](const std::string&) { stuck(); });
    return {};
  }

  void apply(const LoopEvent& event) {
    if (const auto* changed = std::get_if<EyesChanged>(&event)) eyes = *changed;
    if (const auto* changed = std::get_if<MaskChanged>(&event)) servo.mask = changed->phase;
    if (const auto* changed = std::get_if<ServoChanged>(&event)) {
      servo.open = changed->open;
      servo.tick = changed->tick;
    }
  }

  TrackerStatus tracker_status() { return {eyes.phase, clock.now_ns() - eyes.time_ns}; }
  KeeperReport tracker_report() const { return tracker_line ? tracker_line->report() : tracker_datagrams->report(); }
};

Station::Station(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
Station::~Station() = default;

Result<std::unique_ptr<Station>> Station::start(const StationPlan& plan, ipc::DevicePage& page, bool memory_locked,
                                                std::function<void()> stuck) {
  auto state = std::make_unique<Impl>(plan);
  if (Result<void> started = state->start_simulators(); !started) return fail(std::move(started.error()));
  state->make_keepers();
  if (Result<void> started = state->start_loop(page, memory_locked, std::move(stuck)); !started) return fail(std::move(started.error()));
  return std::unique_ptr<Station>(new Station(std::move(state)));
}

bool Station::send(const LoopCommand& command) { return impl_->loop->send(command); }

std::vector<ipc::DeviceInfo> Station::poll() {
  while (const std::optional<LoopEvent> event = impl_->loop->next_event()) impl_->apply(*event);
  const auto& settings = impl_->plan.settings;
  std::vector<ipc::DeviceInfo> all;
  if (impl_->plan.has_tracker()) all.push_back(tracker_info(settings.eye_tracker, impl_->tracker_status(), impl_->tracker_report()));
  if (impl_->plan.has_servo()) all.push_back(servo_info(settings.prism_servo, impl_->servo, impl_->servo_line->report()));
  return all;
}

const std::string& Station::refused() const { return impl_->loop_thread->refused(); }

const daemon::Heartbeat& Station::heartbeat() const { return impl_->loop_thread->heartbeat(); }

}  // namespace prismesh::deviced
