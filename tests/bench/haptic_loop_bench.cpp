// Measures a tick of the haptic loop: proxy, forces, safety; CPU time. Goal: at most 20 us for 99 of 100 ticks, whatever the mesh.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/haptics/haptic_loop.h"
#include "tests/drivers/haptics/field_rig.h"

namespace prismesh::drivers::haptics {
namespace {

std::int64_t thread_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

/// A wavy sheet as triangles, `side` quads in each direction over 60 mm, as a drag has moved it.
test::Triangles wavy_sheet(int side, double lift_mm) {
  const auto node = [&](int i, int j) {
    const double x = 60.0 * i / side - 30, y = 60.0 * j / side - 30;
    return Eigen::Vector3d(x, y, 0.5 * std::sin(0.3 * x) + lift_mm * std::exp(-(x * x + y * y) / 200));
  };
  test::Triangles all;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (const test::Triangle& t : test::quad(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))) all.push_back(t);
  return all;
}

/// `moving`: every fifth tick brings a field whose shells have moved by up to 1 mm. `side`: the sheet has side x side quads.
void tick_of_the_haptic_loop(benchmark::State& state, bool moving) {
  const int side = static_cast<int>(state.range(0));
  // Distances of the plain sheet are near enough for the time of a tick.
  const auto distance = [](double lift) {
    return
        [lift](const Eigen::Vector3d& at) { return std::abs(at.z() - lift * std::exp(-(at.x() * at.x() + at.y() * at.y()) / 200)) * 0.9; };
  };
  const std::array<std::unique_ptr<HapticField>, 2> fields = {test::make_field(distance(0)), test::make_field(distance(1))};
  const test::Triangles low = wavy_sheet(side, 0), high = wavy_sheet(side, 1);
  if (moving) test::enter_moved(*fields[1], low, high);
  if (moving) test::enter_moved(*fields[0], high, low);
  haptic_pen::PenLimits device;
  device.max_newton = 8;
  device.max_axis_newton.setConstant(8);
  device.damping_newton_s_m = 1;
  device.friction_newton = 0.1;
  device.delay_ns = 1'000'000;
  HapticLoop loop({}, device);
  HapticTick tick;
  tick.now_ns = 1'000'000'000;
  tick.pen.phase = haptic_pen::PenPhase::ready;
  tick.pen.fresh = true;
  std::uint64_t generation = 1;
  std::size_t shown = 0;
  int touching = 0, attached = 0, ticks = 0;
  const auto run = [&] {
    tick.now_ns += 1'000'000;
    ++ticks;
    const double seconds = static_cast<double>(ticks) * 1e-3;
    tick.pen.pose.measured_ns = tick.now_ns;
    tick.pen.pose.position_mm = {8 * std::sin(2 * seconds), 6 * std::sin(3 * seconds), 4 * std::sin(9 * seconds)};
    if (moving && ticks % 5 == 0) {
      shown = 1 - shown;
      HapticField& field = *fields[shown];
      field.before_generation = generation;
      field.mesh_generation = field.number = ++generation;
    }
    fields[shown]->time_ns = tick.now_ns;
    tick.sources.field = fields[shown].get();
    tick.rearm = ticks % 1000 == 1;
    const std::int64_t began = thread_ns();
    const HapticAnswer answer = loop.step(tick);
    const std::int64_t ended = thread_ns();
    touching += answer.contact.touching;
    attached += answer.contact.attached;
    return static_cast<double>(ended - began) * 1e-3;
  };
  for (auto _ : state) state.SetIterationTime(run() * 1e-6);
  std::vector<double> costs_us(20'000);
  for (double& cost : costs_us) cost = run();
  std::sort(costs_us.begin(), costs_us.end());
  state.counters["median_us"] = costs_us[costs_us.size() / 2];
  state.counters["p99_us"] = costs_us[costs_us.size() * 99 / 100];
  state.counters["worst_us"] = costs_us.back();
  state.counters["touching"] = static_cast<double>(touching) / ticks;
  state.counters["attached"] = static_cast<double>(attached) / ticks;
}
BENCHMARK_CAPTURE(tick_of_the_haptic_loop, still, false)->ArgName("side")->Arg(10)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tick_of_the_haptic_loop, moving, true)
    ->ArgName("side")
    ->Arg(10)
    ->Arg(30)
    ->Arg(60)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prismesh::drivers::haptics
