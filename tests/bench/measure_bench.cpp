// Cuts a million shells with a plane, and measures along their surface.
#include <benchmark/benchmark.h>

#include "mesh/measure/cross_section.h"
#include "mesh/measure/lengths.h"
#include "tests/bench/million_quads.h"

namespace {

using namespace prismesh;

/// What a step of a dragged plane costs.
void cut(benchmark::State& state) {
  const mesh::Model& model = mesh::bench::million_quads();
  std::size_t shells = 0;
  double x = 100;
  for (auto _ : state) {
    const auto section = mesh::measure::cross_section(model, {{x, 0, 0}, {1, 0.3, 0}});
    shells = section->shells;
    x += 1.7;
  }
  state.counters["shells"] = static_cast<double>(shells);
}
BENCHMARK(cut)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// Argument: how many edges apart.
void along_surface(benchmark::State& state) {
  const mesh::Model& model = mesh::bench::million_quads();
  const mesh::NodeIndex a(model.node_count() / 2), b(model.node_count() / 2 + static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(mesh::measure::length_along_surface(model, a, b));
}
BENCHMARK(along_surface)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
