// Measures the distances of 100,000 points from a surface: building the tree and searching it. Run with --benchmark_repetitions for
// medians.
#include <vector>

#include <benchmark/benchmark.h>

#include "mesh/spatial/surface_distance.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::spatial {
namespace {

constexpr std::size_t kPoints = 100'000;

/// The first shells of the million quads: whole rows of them.
ShellSet first_shells(std::size_t count) {
  ShellSet shells;
  for (std::size_t s = 0; s < count; ++s) shells.emplace_back(s);
  return shells;
}

/// Points some 2 mm off the surface, in the order of the mesh or out of order.
std::vector<Vec3> points_over(std::size_t shells, bool in_order) {
  const Model& model = bench::million_quads();
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const std::size_t shell = (in_order ? i : i * 7919) % shells;
    points.push_back(model.position(model.shell_nodes[shell].node[0]) + Vec3(1.7, 2.1, 2.0 + 0.001 * static_cast<double>(i % 1000)));
  }
  return points;
}

void tree_is_built(benchmark::State& state) {
  const ShellSet shells = first_shells(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    ShellTree tree(bench::million_quads(), shells);
    benchmark::DoNotOptimize(tree);
  }
}
BENCHMARK(tree_is_built)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void points_are_asked(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const ShellTree tree(bench::million_quads(), first_shells(count));
  const std::vector<Vec3> points = points_over(count, state.range(1) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(distances_to(tree, points));
}
BENCHMARK(points_are_asked)
    ->ArgsProduct({{100'000, 1'000'000}, {1, 0}})
    ->ArgNames({"shells", "in order"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

void built_and_asked(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const ShellSet shells = first_shells(count);
  const std::vector<Vec3> points = points_over(count, true);
  for (auto _ : state) benchmark::DoNotOptimize(distances_to(ShellTree(bench::million_quads(), shells), points));
}
BENCHMARK(built_and_asked)->Arg(100'000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace
}  // namespace prismesh::mesh::spatial
