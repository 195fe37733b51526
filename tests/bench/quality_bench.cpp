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

void judge_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(judge_model(model, default_criteria(), 5.0));
}
BENCHMARK(judge_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void report_of_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(report(model, default_criteria(), 5.0, {}));
}
BENCHMARK(report_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void judge_ten_thousand_points(benchmark::State& state) {
  const Model& model = bench::million_quads();
  std::vector<Vec3> moving;
  std::vector<std::array<std::int32_t, 4>> corners;
  constexpr std::int32_t kSide = 100;
  for (std::size_t j = 0; j <= kSide; ++j)
    for (std::size_t i = 0; i <= kSide; ++i) moving.push_back(model.positions[j * 1001 + i]);
  for (std::int32_t j = 0; j < kSide; ++j)
    for (std::int32_t i = 0; i < kSide; ++i) {
      const std::int32_t a = j * (kSide + 1) + i;
      corners.push_back({a, a + 1, a + kSide + 2, a + kSide + 1});
    }
  std::vector<ShellState> states(corners.size());
  for (auto _ : state) {
    judge_points(moving, {}, corners, {}, default_criteria(), 5.0, states);
    benchmark::DoNotOptimize(states.data());
  }
}
BENCHMARK(judge_ten_thousand_points)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prismesh::mesh::quality
