// Measures the search for flanges in a million shells: the sample, whose parts have flanges, and two sheets that lie on each other
// everywhere, so that each shell has a stack.
#include <filesystem>
#include <memory>

#include <benchmark/benchmark.h>

#include "mesh/connections/find_flanges.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/box_tree.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::bench {
namespace {

void search_flanges(benchmark::State& state, const Model& model) {
  std::size_t flanges = 0;
  for ([[maybe_unused]] auto _ : state) flanges = connections::find_flanges(model, spatial::BoxTree(model)).all.size();
  state.counters["shells"] = static_cast<double>(model.shell_count());
  state.counters["flanges"] = static_cast<double>(flanges);
}

void find_flanges_of_the_sample(benchmark::State& state) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "flange_bench.k";
  if (!deck::write_sample(path, 1'000'000)) return state.SkipWithError("the sample can't be written");
  const auto opened = deck::open(path);
  std::filesystem::remove(path);
  if (!opened) return state.SkipWithError("the sample can't be opened");
  search_flanges(state, opened->model);
}
BENCHMARK(find_flanges_of_the_sample)->Unit(benchmark::kMillisecond)->UseRealTime();

void find_flanges_of_two_plates(benchmark::State& state) {
  Model model = million_quads();
  constexpr std::size_t kSide = 1000, kStride = kSide + 1;
  for (std::size_t s = kSide * kSide / 2; s < kSide * kSide / 2 + kSide; ++s) model.shell_nodes.set(s, ShellNodes{});  // a gap
  for (std::size_t j = kStride / 2 + 1; j < kStride; ++j)
    for (std::size_t i = 0; i < kStride; ++i)
      model.positions.set(j * kStride + i, model.positions[(j - kStride / 2 - 1) * kStride + i] + Vec3(1.3, 2.1, 1.2));
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  search_flanges(state, model);
}
BENCHMARK(find_flanges_of_two_plates)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh::bench
