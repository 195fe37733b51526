// Measures all metrics of a million quads in one pass on one thread, beside the Verdict library in the same run where the machine has it;
// judging the whole model, and again what an edit touched.
#include <algorithm>
#include <array>
#include <ctime>
#include <memory>

#include <benchmark/benchmark.h>

#include "mesh/model/adjacency.h"
#include "mesh/quality/composite.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/metrics.h"
#include "mesh/quality/report.h"
#include "mesh/quality/structure.h"
#include "mesh/quality/target_size.h"
#include "tests/bench/million_quads.h"
#include "tests/support/verdict_library.h"

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

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// The corners of a quad in the form that Verdict takes.
void corners_of(const Model& model, std::size_t shell, double (&coordinates)[4][3]) {
  const ShellNodes& nodes = model.shell_nodes[shell];
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3& p = model.position(nodes.node[c]);
    for (std::size_t axis = 0; axis < 3; ++axis) coordinates[c][axis] = p[static_cast<Eigen::Index>(axis)];
  }
}

/// Nine metrics each, the same or the nearest that Verdict has, in turns: the ratio of CPU times doesn't depend on who else is
/// on the machine. `together`: Verdict works all out in one call, which it offers besides a call each.
void beside_verdict(benchmark::State& state, bool together) {
  constexpr std::size_t kMetrics = 9;
  const test::VerdictLibrary& library = test::VerdictLibrary::get();
  if (!library.is_there()) return state.SkipWithError(test::VerdictLibrary::how_to_get());
  constexpr std::array<const char*, kMetrics> kNames = {"quad_warpage",         "quad_edge_ratio",   "quad_skew",
                                                        "quad_scaled_jacobian", "quad_taper",        "quad_minimum_angle",
                                                        "quad_maximum_angle",   "quad_aspect_ratio", "quad_area"};
  std::array<test::VerdictLibrary::Metric, kMetrics> metrics{};
  std::transform(kNames.begin(), kNames.end(), metrics.begin(), [&](const char* name) { return library.metric(name); });
  const auto all = library.all_of_quad();
  if (all == nullptr || std::find(metrics.begin(), metrics.end(), nullptr) != metrics.end())
    return state.SkipWithError("this Verdict library has other names");

  const Model& model = bench::million_quads();
  std::vector<Values> values(model.shell_count());
  std::vector<std::array<double, kMetrics>> theirs(model.shell_count());
  double ours_ms = 0, theirs_ms = 0;
  for (auto _ : state) {
    const double begin = cpu_ms();
    measure_range(model, 0, model.shell_count(), values);
    benchmark::DoNotOptimize(values.data());
    const double middle = cpu_ms();
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      double coordinates[4][3];
      corners_of(model, s, coordinates);
      if (together) {
        const test::VerdictLibrary::QuadValues found = all(coordinates);
        std::copy_n(found.begin(), kMetrics, theirs[s].begin());
      } else {
        for (std::size_t m = 0; m < kMetrics; ++m) theirs[s][m] = metrics[m](4, coordinates);
      }
    }
    benchmark::DoNotOptimize(theirs.data());
    ours_ms += middle - begin;
    theirs_ms += cpu_ms() - middle;
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["ours_ms"] = ours_ms / rounds;
  state.counters["verdict_ms"] = theirs_ms / rounds;
  state.counters["times_quicker"] = theirs_ms / ours_ms;
}
BENCHMARK_CAPTURE(beside_verdict, a_call_each, false)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK_CAPTURE(beside_verdict, all_in_one_call, true)->Unit(benchmark::kMillisecond)->Iterations(3);

void judge_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(judge_model(model, {default_criteria(), 5.0}));
}
BENCHMARK(judge_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// Each shell by the target size of its part.
void judge_a_million_by_part(benchmark::State& state) {
  const Model& model = bench::million_quads();
  const CriteriaByPart by_part = share_entries(std::vector<PartCriteria>(model.parts->size(), PartCriteria{5.0, nullptr, SizeFrom::part}));
  for (auto _ : state) benchmark::DoNotOptimize(judge_model(model, {default_criteria(), 99.0, &by_part}));
}
BENCHMARK(judge_a_million_by_part)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void report_of_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(report(model, {default_criteria(), 5.0}, {}));
}
BENCHMARK(report_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// An edit of 10,000 shells: only those are measured.
void rejudge_ten_thousand_of_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  const ChunkedArray<ShellState> judged = judge_model(model, {default_criteria(), 5.0});
  const Counts counts = count(judged);
  ShellSet shells;
  for (std::size_t j = 0; j < 100; ++j)
    for (std::size_t i = 0; i < 100; ++i) shells.emplace_back((400 + j) * 1000 + 400 + i);
  for (auto _ : state) {
    ChunkedArray<ShellState> states = judged;
    Counts now = counts;
    rejudge(model, {default_criteria(), 5.0}, shells, states, now);
    benchmark::DoNotOptimize(now);
  }
}
BENCHMARK(rejudge_ten_thousand_of_a_million)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

void composites_of_a_hundred(benchmark::State& state) {
  const Model& model = bench::million_quads();
  std::vector<ShellIndex> shells;
  for (std::size_t s = 0; s < 100; ++s) shells.emplace_back(500'500 + s);
  std::vector<float> figures(shells.size());
  for (auto _ : state) {
    composites(model, shells, {default_criteria(), 5.0}, figures);
    benchmark::DoNotOptimize(figures.data());
  }
}
BENCHMARK(composites_of_a_hundred)->Unit(benchmark::kMicrosecond);

void structure_of_a_million(benchmark::State& state) {
  Model model = bench::million_quads();
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  for (auto _ : state) benchmark::DoNotOptimize(check_structure(model));
}
BENCHMARK(structure_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

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
    judge_points({moving, {}, corners, {}}, {default_criteria(), 5.0}, states);
    benchmark::DoNotOptimize(states.data());
  }
}
BENCHMARK(judge_ten_thousand_points)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prismesh::mesh::quality
