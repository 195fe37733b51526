// Measures adjacency and feature edges of a million quads.
#include <benchmark/benchmark.h>

#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"
#include "mesh/model/topology_change.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh {
namespace {

void build_adjacency_of_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(build_adjacency(model));
}
BENCHMARK(build_adjacency_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// After one in so many quads was split in two.
void update_adjacency_of_a_million(benchmark::State& state) {
  Model before = bench::million_quads();
  before.shell_ids.resize(before.shell_count());
  before.shell_index = std::make_shared<const IdIndex>();
  before.adjacency = std::make_shared<const Adjacency>(build_adjacency(before));
  Model after = before;
  const auto split = static_cast<std::size_t>(state.range(0));
  for (std::size_t i = 0; i < split; ++i) {
    const ShellIndex shell(i * (before.shell_count() / split));
    const auto n = before.shell(shell).node;
    set_shell_nodes(after, shell, {{n[0], n[1], n[2], n[2]}});
    add_shell(after, static_cast<std::int64_t>(10'000'000 + i), {{n[0], n[2], n[3], n[3]}}, shell);
  }
  for (auto _ : state) benchmark::DoNotOptimize(update_adjacency(before, after));
}
BENCHMARK(update_adjacency_of_a_million)
    ->Arg(1)
    ->Arg(1000)
    ->Arg(20000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void classify_edges_of_a_million(benchmark::State& state) {
  Model model = bench::million_quads();
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  for (auto _ : state) benchmark::DoNotOptimize(classify_edges(model, 30));
}
BENCHMARK(classify_edges_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh
