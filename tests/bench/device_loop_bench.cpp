// Measures a tick of the device loop: the real loop with its drivers, filter, mask control and page; the devices are simulated at the
// other ends of cables in memory. CPU time of the loop alone. Goal: at most 20 us at 200 Hz or more.
#include <algorithm>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/daemon/deviced/loop_rig.h"

namespace prismesh::deviced {
namespace {

std::int64_t cpu_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

/// `seen` false: the head has gone, and the mask is parked.
void tick_of_the_loop(benchmark::State& state, bool seen) {
  RigOptions options;
  bool there = true;
  options.head = [&there](double seconds) {
    drivers::eye_tracker::SimulatedHead head = swaying_head(seconds);
    head.visible = there;
    return head;
  };
  LoopRig rig(options);
  rig.run_for_ms(3000);
  there = seen;
  rig.run_for_ms(1000);
  std::int64_t began = 0;
  std::vector<double> costs_us;
  rig.before_tick = [&] { began = cpu_ns(); };
  rig.after_tick = [&] { costs_us.push_back(static_cast<double>(cpu_ns() - began) * 1e-3); };
  for (auto _ : state) {
    costs_us.clear();
    rig.tick();
    state.SetIterationTime(costs_us.back() * 1e-6);
  }
  costs_us.clear();
  costs_us.reserve(5000);
  for (int i = 0; i < 5000; ++i) rig.tick();
  const auto share = [&](double of) {
    const auto at = costs_us.begin() + static_cast<std::ptrdiff_t>(of * static_cast<double>(costs_us.size() - 1));
    std::nth_element(costs_us.begin(), at, costs_us.end());
    return *at;
  };
  state.counters["median_us"] = share(0.5);
  state.counters["p99_us"] = share(0.99);
  state.counters["worst_us"] = share(1);
}

BENCHMARK_CAPTURE(tick_of_the_loop, following, true)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tick_of_the_loop, searching, false)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// The clock's own part of the figures above.
void measuring(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(cpu_ns());
}
BENCHMARK(measuring);

}  // namespace
}  // namespace prismesh::deviced
