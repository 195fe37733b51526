// Shows the eye tracker, the prism servo, the haptic pen and their control loops.
#include <cmath>
#include <ostream>
#include <thread>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/counted.h"
#include "cli/commands.h"
#include "cli/device_figures.h"
#include "cli/json_output.h"
#include "cli/pen_look.h"
#include "cli/pen_record.h"
#include "cli/report_text.h"
#include "ipc/device/client.h"

namespace prismesh::cli {

namespace {

constexpr std::chrono::seconds kDevicedPatience{15};
constexpr std::chrono::seconds kWatchPeriod{1};

Result<DeviceFigures> look(ipc::DeviceClient& client, const DevicesOptions& options) {
  Result<ipc::DeviceAnswer> answer = client.call(ipc::GetDevices{});
  while (client.next_event()) {
  }  // the answer has the same information
  if (!answer) return fail(std::move(answer.error()));
  auto* devices = std::get_if<ipc::Devices>(&*answer);
  if (devices == nullptr) return fail("", "the device daemon's answer isn't a list of devices");
  DeviceFigures figures;
  figures.devices = std::move(*devices);
  figures.eyes = client.page().eyes().value_or(ipc::EyesState{});
  figures.mask = client.page().prism().value_or(ipc::PrismState{});
  figures.loop = client.page().health().value_or(ipc::DeviceHealth{});
  Result<std::optional<PenFigures>> pen = look_at_pen(options);
  if (!pen) return fail(std::move(pen.error()));
  figures.pen = std::move(*pen);
  MonotonicClock clock;
  figures.now_ns = clock.now_ns();
  return figures;
}

std::string eyes_text(const DeviceFigures& figures) {
  const ipc::EyesState& eyes = figures.eyes;
  const auto age_ms = figures.age_ms(eyes.measured_ns);
  if (!age_ms) return "no head has been seen yet";
  const auto mm = [&](std::size_t axis) { return std::round(eyes.between_eyes_mm[axis]) + 0.0; };  // no "-0"
  return fmt::format("head at ({:.0f}, {:.0f}, {:.0f}) mm, measured {:.0f} ms ago; lost {} since the daemon's start", mm(0), mm(1), mm(2),
                     *age_ms, counted(eyes.times_lost, "time"));
}

std::string mask_text(const DeviceFigures& figures) {
  const ipc::PrismState& mask = figures.mask;
  const auto age_ms = figures.age_ms(mask.measured_ns);
  if (!age_ms) return "the mask's position isn't known";
  return fmt::format("mask at {:.3f} mm (goal {:.3f}), measured {:.0f} ms ago; {}", mask.position_mm, mask.goal_mm, *age_ms,
                     mask.stereo_allowed ? "stereo" : "no stereo now");
}

std::string loop_text(const DeviceFigures& figures) {
  const ipc::DeviceHealth& loop = figures.loop;
  const auto beat_ms = figures.age_ms(loop.heartbeat_ns);
  if (!beat_ms) return "it hasn't started";
  return fmt::format(
      "process {}: {}, last {:.0f} ms ago, {} late (worst {:.1f} ms), {:.1f} us of CPU a tick; real-time priority {}, memory {}", loop.pid,
      counted(loop.ticks, "tick"), *beat_ms, loop.ticks_late, static_cast<double>(loop.worst_late_ns) * 1e-6,
      static_cast<double>(loop.tick_cpu_ns) * 1e-3, loop.realtime ? "granted" : "refused", loop.memory_locked ? "locked" : "not locked");
}

void print(std::ostream& out, const DeviceFigures& figures) {
  out << "display profile " << printable(figures.devices.profile) << '\n';
  if (figures.devices.devices.empty()) out << "no device is configured: docs/settings.md says how to name one in prismesh.toml\n";
  for (const ipc::DeviceInfo& device : figures.devices.devices) {
    out << device.role << ": " << device.state << " (" << device.kind << (device.simulated ? ", simulated" : "") << ", "
        << printable(device.where) << ")\n"
        << "  " << (device.role == "eye tracker" ? eyes_text(figures) : mask_text(figures)) << '\n';
    if (!device.trouble.empty()) out << "  trouble: " << printable(device.trouble) << '\n';
  }
  out << "loop: " << loop_text(figures) << '\n';
  if (figures.pen) out << pen_text(*figures.pen, figures.now_ns);
}

/// Does what the options ask for before the state is printed.
Result<void> act(ipc::DeviceClient& client, const DevicesOptions& options) {
  if (options.reload)
    if (Result<ipc::DeviceAnswer> done = client.call(ipc::Reload{}); !done) return fail(std::move(done.error()));
  if (options.rearm)
    if (Result<ipc::DeviceAnswer> done = client.call(ipc::Rearm{}); !done) return fail(std::move(done.error()));
  return act_on_pen(options);
}

Result<void> act_and_print(ipc::DeviceClient& client, const DevicesOptions& options, bool first, const Common& common,
                           const Context& context) {
  if (first)
    if (Result<void> acted = act(client, options); !acted) return acted;
  const Result<DeviceFigures> figures = look(client, options);
  if (!figures) return fail(figures.error());
  if (common.json)
    context.out << devices_json(*figures) << '\n';
  else
    print(context.out, *figures);
  context.out.flush();
  return {};
}

/// Prints until the user stops it; connects again when the daemon was restarted.
void watch(ipc::ReconnectingDeviceClient& connection, const DevicesOptions& options, const Common& common, const Context& context) {
  const auto pause = [&] {
    for (auto slept = std::chrono::milliseconds(0); slept < kWatchPeriod && !context.stop(); slept += std::chrono::milliseconds(50))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  };
  // the first state was printed already
  for (pause(); !context.stop() && context.out.good(); pause()) {
    if (const Result<ipc::DeviceClient*> client = connection.wait(kDevicedPatience); !client)
      say(context, client.error());
    else if (const Result<void> printed = act_and_print(**client, options, false, common, context); !printed)
      connection.lost(printed.error());
  }
}

}  // namespace

int devices(const DevicesOptions& options, const Common& common, const Context& context) {
  if (options.replay) {
    const Result<ReplayedPen> replayed = replay_pen(*options.replay, common.json);
    if (!replayed) {
      say(context, replayed.error());
      return kFailed;
    }
    context.out << replayed->text;
    return replayed->same ? kDone : kFailed;
  }
  if (options.self_test || options.record) {
    const Result<void> acted = act_on_pen(options);
    const Result<std::string> measured = !acted           ? Result<std::string>(fail(acted.error()))
                                         : options.record ? record_pen(options, context)
                                                          : pen_self_test(options);
    if (!measured) {
      say(context, measured.error());
      return kFailed;
    }
    context.out << *measured;
    return kDone;
  }
  ipc::ReconnectingDeviceClient connection(ipc::device_socket_path(options.runtime_directory), "prismesh devices");
  const Result<ipc::DeviceClient*> client = connection.wait(std::chrono::milliseconds(0));
  if (!client) {
    say(context, client.error());
    return kFailed;
  }
  if (const Result<void> printed = act_and_print(**client, options, true, common, context); !printed) {
    say(context, printed.error());
    return kFailed;
  }
  if (options.watch) watch(connection, options, common, context);
  return kDone;
}

}  // namespace prismesh::cli
