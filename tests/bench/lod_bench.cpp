// Builds levels of detail, and chooses from them.
#include <benchmark/benchmark.h>

#include "mesh/lod/choose.h"
#include "mesh/lod/levels.h"
#include "tests/bench/million_quads.h"

namespace {

using namespace prismesh;

void build(benchmark::State& state) {
  const mesh::Model& model = mesh::bench::million_quads();
  mesh::lod::Levels levels;
  for (auto _ : state) levels = mesh::lod::build_levels(model).value();
  state.counters["clusters"] = static_cast<double>(levels.clusters.size());
  state.counters["coarse"] = static_cast<double>(levels.triangles.size());
}
BENCHMARK(build)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// The whole sheet fills 1900 pixels. Argument: tenths of a pixel.
void choose(benchmark::State& state) {
  static const mesh::lod::Levels levels = mesh::lod::build_levels(mesh::bench::million_quads()).value();
  const mesh::lod::Viewpoint view{{2500, 2500, 6000}, 1900.0 / 5000 * 6000, 1};
  std::vector<std::uint32_t> clusters;
  for (auto _ : state) {
    clusters.clear();
    mesh::lod::choose(levels, {}, view, {static_cast<double>(state.range(0)) / 10}, clusters);
  }
  state.counters["triangles"] = static_cast<double>(mesh::lod::triangles_of(levels, clusters));
  state.counters["clusters"] = static_cast<double>(clusters.size());
}
BENCHMARK(choose)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMicrosecond);

}  // namespace
