// All metrics of a million quads in one pass on one thread, and judging the whole model.
#include <benchmark/benchmark.h>

#include "mesh/quality/metrics.h"
#include "mesh/quality/report.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::quality {
namespace {

void all_metrics_of_a_million_single_threaded(benchmark::State& state) {
  const Model& model = bench::million_quads();
  std::vector<Values> values(model.shell_count());
  for (auto _ : state) {
    measure_range(model, 0, model.shell_count(), values);
    benchmark::DoNotOptimize(values.data());
  }
}
BENCHMARK(all_metrics_of_a_million_single_threaded)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prismesh::mesh::quality
