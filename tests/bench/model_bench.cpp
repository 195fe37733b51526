// Adjacency and feature edges of a million quads.
#include <benchmark/benchmark.h>

#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh {
namespace {

void build_adjacency_of_a_million(benchmark::State& state) {
  const Model& model = bench::million_quads();
  for (auto _ : state) benchmark::DoNotOptimize(build_adjacency(model));
}
BENCHMARK(build_adjacency_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void classify_edges_of_a_million(benchmark::State& state) {
  Model model = bench::million_quads();
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  for (auto _ : state) benchmark::DoNotOptimize(classify_edges(model, 30));
}
BENCHMARK(classify_edges_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh
