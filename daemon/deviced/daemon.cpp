#include "daemon/deviced/daemon.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/log.h"
#include "daemon/common/service.h"
#include "daemon/deviced/loop_thread.h"
#include "daemon/deviced/station.h"
#include "ipc/device/client.h"
#include "ipc/device/messages_json.h"
#include "ipc/device/page.h"
#include "ipc/device/roles.h"

namespace prismesh::deviced {

namespace {

using Time = std::chrono::steady_clock;

/// How often the main thread reads the loop's events.
constexpr std::chrono::milliseconds kPollPeriod{20};
/// Min. time between two messages and log lines about a device that keeps changing; the state page shows every change.
constexpr std::chrono::milliseconds kReportPause{500};

ipc::ServerLimits limits() {
  ipc::ServerLimits limits;
  limits.line_bytes = std::size_t{64} * 1024;
  limits.queue_bytes = std::size_t{1024} * 1024;
  return limits;
}

/// Called on the watchdog's thread while the loop hangs, so the devices can't be shut down in order.
[[noreturn]] void end_stuck() {
  logging::critical("the device loop hangs, so this daemon ends to be started again; the prism servo stops by its own watchdog");
  logging::flush();
  std::_Exit(kStuckStatus);
}

void log(const ipc::DeviceInfo& device) {
  const std::string what =
      device.role + " (" + device.kind + (device.simulated ? ", simulated" : "") + ", " + device.where + "): " + device.state;
  if (device.trouble.empty())
    logging::info("{}", what);
  else
    logging::warn("{}: {}", what, device.trouble);
}

struct DeviceProtocol {
  using Request = ipc::DeviceRequest;
  using Answer = ipc::DeviceAnswer;
  using Event = ipc::DeviceEvent;
  using Hello = ipc::DeviceHello;
  static constexpr int kVersion = ipc::kDeviceProtocolVersion;
  static auto decode(std::string_view line) { return ipc::decode_device_request(line); }
  static std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
    return ipc::encode_device_answer(to, answer, descriptors);
  }
  static std::string encode_event(const Event& event) { return ipc::encode_device_event(event); }
  static bool must_be_told(const Answer&) { return false; }
};

}  // namespace

struct Daemon::Impl final : daemon::Service<DeviceProtocol> {
  Impl(DaemonOptions wanted, StationPlan sound, ipc::DevicePage device_page)
      : options(std::move(wanted)), plan(std::move(sound)), page(std::move(device_page)) {}

  struct Reported {
    ipc::DeviceInfo device;
    Time::time_point at;
  };

  DaemonOptions options;
  StationPlan plan;
  ipc::DevicePage page;
  bool memory_locked = false;
  std::set<ipc::ClientId> showing_stereo;
  bool picture_mono = true;  ///< as last sent to the loop
  std::optional<ipc::ClientId> holder;
  ipc::HoldMask hold;
  std::deque<LoopCommand> pending_commands;  ///< commands that didn't fit into the loop's ring
  std::vector<ipc::DeviceInfo> devices;
  std::map<std::string, Reported> reported;  ///< by role
  std::string no_station;                    ///< why no station runs; empty: one does
  std::optional<daemon::HeartbeatMonitor> ticking;
  std::unique_ptr<Station> station;  // last: it ends before the page that it writes to

  // --- the station ---

  Result<void> start_station() {
    ticking.reset();
    station.reset();
    pending_commands.clear();
    Result<std::unique_ptr<Station>> started = Station::start(plan, page, memory_locked, end_stuck);
    if (!started) return fail(std::move(started.error()));
    station = std::move(*started);
    ticking.emplace("no tick came in time", station->heartbeat(), 1);
    if (!station->refused().empty()) logging::warn("{}", station->refused());
    if (!picture_mono) send_to_loop(SetPictureMono{false});
    if (holder) send_to_loop(SetHold{hold.position_mm});
    return {};
  }

  /// A tick was in time since the last report.
  bool is_well() override { return !ticking || !ticking->is_hung(); }

  void send_to_loop(const LoopCommand& command) {
    // Only the newest command of each kind is kept, so that a client can't fill the memory.
    std::erase_if(pending_commands, [&](const LoopCommand& older) { return older.index() == command.index(); });
    pending_commands.push_back(command);
    while (station && !pending_commands.empty() && station->send(pending_commands.front())) pending_commands.pop_front();
  }

  void poll_station() {
    if (!station) return;
    while (!pending_commands.empty() && station->send(pending_commands.front())) pending_commands.pop_front();
    devices = station->poll();
    for (const ipc::DeviceInfo& device : devices) {
      const Time::time_point now = Time::now();
      // Changes while a station starts aren't reported.
      Reported& last = reported.try_emplace(device.role, Reported{{}, now}).first->second;
      if (last.device == device || now - last.at < kReportPause) continue;
      last = {device, now};
      log(device);
      tell_all(ipc::DeviceChanged{device});
    }
  }

  void picture_shown() {
    if (std::exchange(picture_mono, showing_stereo.empty()) != picture_mono) send_to_loop(SetPictureMono{picture_mono});
  }

  void end_hold() {
    holder.reset();
    send_to_loop(EndHold{});
  }

  // --- from the socket ---

  Result<Welcomed> welcome(ipc::ClientId) override {
    Result<ipc::Descriptor> shared = page.descriptor().duplicate();
    if (!shared) return fail(std::move(shared.error()));
    Welcomed welcomed{ipc::DeviceWelcome{ipc::kDeviceProtocolVersion, PRISMESH_VERSION}, {}};
    welcomed.descriptors.push_back(std::move(*shared));
    return welcomed;
  }

  void request(ipc::ClientId client, std::uint64_t number, ipc::DeviceRequest request, std::size_t) override {
    if (const auto* shown = std::get_if<ipc::PictureShown>(&request)) {
      if (shown->mono)
        showing_stereo.erase(client);
      else
        showing_stereo.insert(client);
      return picture_shown();
    }
    answer(client, number, std::visit([&](const auto& wanted) { return done(client, wanted); }, request));
  }

  void left(ipc::ClientId client) override {
    if (holder == client) end_hold();
    // The picture that this client drew is no longer shown.
    if (showing_stereo.erase(client) > 0) picture_shown();
  }

  // --- what is asked for ---

  template <class Other>
  ipc::DeviceAnswer done(ipc::ClientId, const Other&) {
    return ipc::Done{};  // hello and picture_shown are handled elsewhere
  }

  ipc::DeviceAnswer done(ipc::ClientId, const ipc::GetDevices&) {
    if (!station) return ipc::Failed{"", 0, no_station};
    poll_station();
    return ipc::Devices{devices, plan.profile.name};
  }

  std::optional<ipc::Failed> no_servo() const {
    if (!station) return ipc::Failed{"", 0, no_station};
    if (plan.has_servo()) return std::nullopt;
    return ipc::Failed{"", 0,
                       plan.profile.mask_moves ? "no prism servo is configured: set prism_servo.driver in prismesh.toml"
                                               : "the display profile \"" + plan.profile.name + "\" has no mask that moves"};
  }

  ipc::DeviceAnswer done(ipc::ClientId client, const ipc::HoldMask& wanted) {
    if (const auto failed = no_servo()) return *failed;
    const double travel_mm = plan.settings.prism_servo.travel_mm;
    if (std::abs(wanted.position_mm) > travel_mm)
      return ipc::Failed{"", 0, fmt::format("position_mm must be from {} to {}, not {}", -travel_mm, travel_mm, wanted.position_mm)};
    if (holder && *holder != client)
      return ipc::Failed{"", 0, "the mask is held by " + greeted().at(*holder) + " already: end that program's calibration first"};
    holder = client;
    hold = wanted;
    send_to_loop(SetHold{wanted.position_mm});
    return ipc::Done{};
  }

  ipc::DeviceAnswer done(ipc::ClientId client, const ipc::ReleaseMask&) {
    if (holder != client) return ipc::Failed{"", 0, "the mask isn't held by this client"};
    end_hold();
    return ipc::Done{};
  }

  ipc::DeviceAnswer done(ipc::ClientId client, const ipc::Rearm&) {
    if (const auto failed = no_servo()) return *failed;
    logging::info("{} (client {}) rearms the prism servo", greeted().at(client), client);
    send_to_loop(RequestRearm{});
    return ipc::Done{};
  }

  ipc::DeviceAnswer done(ipc::ClientId, const ipc::Reload&) {
    Result<StationPlan> fresh = read_plan(options.config);
    if (!fresh) return ipc::failed_from(fresh.error());
    const bool go_on = station && fresh->same_devices(plan);
    plan = std::move(*fresh);
    logging::info("settings and the profile \"{}\" were read again{}", plan.profile.name, go_on ? "" : "; the devices are started anew");
    if (go_on) {
      send_to_loop(SetDisplay{plan.profile.optics, plan.eye_separation_mm()});
      return ipc::Done{};
    }
    if (holder && no_servo()) holder.reset();
    const Result<void> started = start_station();
    if (started) return ipc::Done{};
    no_station = started.error().text();
    logging::error("{}", no_station);
    return ipc::failed_from(started.error());
  }
};

Result<Daemon> Daemon::start(const DaemonOptions& options) {
  Result<StationPlan> plan = read_plan(options.config);
  if (!plan) return fail(std::move(plan.error()));
  Result<ipc::DevicePage> page = ipc::DevicePage::create();
  if (!page) return fail(std::move(page.error()));
  auto state = std::make_unique<Impl>(options, std::move(*plan), std::move(*page));
  if (Result<void> listening = state->listen(ipc::device_socket_path(options.runtime_directory), limits()); !listening)
    return fail(std::move(listening.error()));
  if (const std::string refused = lock_memory(); refused.empty())
    state->memory_locked = true;
  else
    logging::warn("{}", refused);
  if (Result<void> started = state->start_station(); !started) return fail(std::move(started.error()));
  state->every(kPollPeriod, [state = state.get()] { state->poll_station(); });
  return Daemon(std::move(state));
}

Daemon::Daemon(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
Daemon::Daemon(Daemon&&) noexcept = default;
Daemon::~Daemon() = default;

void Daemon::run() { impl_->run("drives the devices"); }
void Daemon::stop() { impl_->stop(); }

}  // namespace prismesh::deviced
