#include "cli/pen_look.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/counted.h"
#include "cli/report_text.h"
#include "ipc/pen/client.h"

namespace prismesh::cli {

namespace {

constexpr std::chrono::seconds kPenPatience{5};
constexpr std::chrono::seconds kTestLength{3};

double in_ms(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }
double in_us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }
double length(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

Result<ipc::PenClient> connect_to_pen(const DevicesOptions& options) {
  return ipc::PenClient::connect(ipc::pen_socket_path(options.runtime_directory), "prismesh devices");
}

}  // namespace

Result<std::optional<PenFigures>> look_at_pen(const DevicesOptions& options) {
  std::error_code problem;
  if (!std::filesystem::exists(ipc::pen_socket_path(options.runtime_directory), problem)) return std::optional<PenFigures>();
  Result<ipc::PenClient> client = connect_to_pen(options);
  if (!client) return fail(std::move(client.error()));
  Result<ipc::PenAnswer> answer = client->call(ipc::GetPen{}, kPenPatience);
  if (!answer) return fail(std::move(answer.error()));
  const auto* pen = std::get_if<ipc::Pen>(&*answer);
  if (pen == nullptr) return fail("", "the pen daemon's answer isn't the state of a pen");
  return PenFigures{pen->pen, client->page().state().value_or(ipc::PenState{}), client->page().health().value_or(ipc::PenHealth{})};
}

Result<void> act_on_pen(const DevicesOptions& options) {
  if (!options.arm_pen && !options.disarm_pen) return {};
  Result<ipc::PenClient> client = connect_to_pen(options);
  if (!client) return fail(std::move(client.error()));
  Result<ipc::PenAnswer> done = options.arm_pen ? client->call(ipc::ArmPen{}, kPenPatience) : client->call(ipc::DisarmPen{}, kPenPatience);
  if (!done) return fail(std::move(done.error()));
  return {};
}

std::string pen_text(const PenFigures& pen, std::int64_t now_ns) {
  if (pen.info.kind.empty()) return "haptic pen: none is configured\n";
  std::string text = fmt::format("haptic pen: {} ({}, {})\n", pen.info.state, pen.info.kind, printable(pen.info.where));
  const ipc::PenState& state = pen.state;
  if (state.measured_ns == 0)
    text += "  no pose has come yet\n";
  else
    text += fmt::format("  at ({:.1f}, {:.1f}, {:.1f}) mm, measured {:.0f} ms ago; force {:.2f} N{}; {}\n", state.position_mm[0] + 0.0,
                        state.position_mm[1] + 0.0, state.position_mm[2] + 0.0, in_ms(now_ns - state.measured_ns), length(state.newton),
                        state.touching ? ", touches a shell" : "", state.field_number == 0 ? "no field" : "has a field of the shells");
  if (!pen.info.trouble.empty()) {
    text += "  trouble: " + printable(pen.info.trouble);
    text += state.stage == ipc::PenStage::latched ? " (prismesh devices --arm-pen)\n" : "\n";
  }
  const ipc::PenHealth& loop = pen.loop;
  if (loop.ticks == 0) return text;
  return text + fmt::format(
                    "  loop: process {}, guard {}: {}, {} late (worst {:.1f} ms), {:.0f} us of CPU for 99 of 100 ticks; the guard "
                    "took the line {}; real-time priority {}, memory {}\n",
                    loop.pid, loop.guard_pid, counted(loop.ticks, "tick"), loop.ticks_late, in_ms(loop.worst_late_ns),
                    in_us(loop.cpu_p99_ns), counted(loop.guard_trips, "time"), loop.realtime ? "granted" : "refused",
                    loop.memory_locked ? "locked" : "not locked");
}

Result<std::string> pen_self_test(const DevicesOptions& options) {
  Result<ipc::PenClient> client = connect_to_pen(options);
  if (!client) return fail(std::move(client.error()));
  const ipc::PenHealth before = client->page().health().value_or(ipc::PenHealth{});
  std::vector<std::int64_t> trips_ns;
  double max_newton = 0, max_step = 0;
  ipc::PenState last;
  const auto until = std::chrono::steady_clock::now() + kTestLength;
  while (std::chrono::steady_clock::now() < until) {
    const ipc::PenState now = client->page().state().value_or(ipc::PenState{});
    if (now.time_ns != last.time_ns) {
      if (now.round_trip_ns > 0) trips_ns.push_back(now.round_trip_ns);
      max_newton = std::max(max_newton, length(now.newton));
      // Only between two ticks that follow each other.
      if (last.time_ns != 0 && now.time_ns - last.time_ns < 1'500'000)
        max_step =
            std::max(max_step, length({now.newton[0] - last.newton[0], now.newton[1] - last.newton[1], now.newton[2] - last.newton[2]}));
      last = now;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  const ipc::PenHealth after = client->page().health().value_or(ipc::PenHealth{});
  if (trips_ns.empty()) return fail("", "no pose has answered a force in three seconds: the pen is " + std::string(name(last.stage)));
  std::sort(trips_ns.begin(), trips_ns.end());
  const auto share = [&](double part) {
    return in_ms(trips_ns[static_cast<std::size_t>(part * static_cast<double>(trips_ns.size() - 1))]);
  };
  return fmt::format(
      "pen self-test, {} s, {}:\n"
      "  jitter: {}, {} late; 99 of 100 late by less than {:.0f} us, the worst since the start {:.1f} ms\n"
      "  delay from a force to the pose that answers it: median {:.2f} ms, 99 of 100 within {:.2f} ms\n"
      "  force: at most {:.3f} N, steps between ticks at most {:.3f} N\n"
      "  CPU of a tick: median {:.0f} us, 99 of 100 within {:.0f} us\n"
      "  the guard took the line {}\n",
      kTestLength.count(), name(last.stage), counted(after.ticks - before.ticks, "tick"), after.ticks_late - before.ticks_late,
      in_us(after.late_p99_ns), in_ms(after.worst_late_ns), share(0.5), share(0.99), max_newton, max_step, in_us(after.cpu_p50_ns),
      in_us(after.cpu_p99_ns), counted(after.guard_trips - before.guard_trips, "time"));
}

}  // namespace prismesh::cli
