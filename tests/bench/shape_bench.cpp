// Measures selections and weights on a million quads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/select/expression.h"
#include "mesh/select/outline.h"
#include "mesh/select/region.h"
#include "mesh/shape/move.h"
#include "mesh/shape/normals.h"
#include "mesh/shape/weights.h"
#include "mesh/spatial/closest_point.h"
#include "mesh/spatial/cut_patch.h"
#include "mesh/spatial/geodesic.h"
#include "tests/bench/million_quads.h"
#include "tests/bench/plain_fast_marching.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh {
namespace {

using test::all_shells;

constexpr std::size_t kSheetStride = 1001;

const Model& whole_sheet() {
  static const Model model = [] {
    Model m = bench::million_quads();
    m.node_holds.resize(m.node_count());
    std::vector<std::int64_t> ids(m.node_count());
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int64_t>(10 * i + 1);
    m.node_index = std::make_shared<IdIndex>(ids);
    ids.resize(m.shell_count());
    m.shell_index = std::make_shared<IdIndex>(ids);
    m.midside = std::make_shared<std::vector<MidsideNodes>>();
    m.adjacency = std::make_shared<const Adjacency>(build_adjacency(m));
    return m;
  }();
  return model;
}

/// A square of 100 x 100 nodes in the middle.
NodeSet ten_thousand() {
  NodeSet nodes;
  for (std::size_t j = 450; j < 550; ++j)
    for (std::size_t i = 450; i < 550; ++i) nodes.push_back(NodeIndex(j * kSheetStride + i));
  return nodes;
}

void weights_of_10000_nodes(benchmark::State& state) {
  const Model& model = whole_sheet();
  const NodeSet selection = ten_thousand();
  for (auto _ : state) benchmark::DoNotOptimize(shape::compute_weights(model, selection, NodeIndex(500 * kSheetStride + 500), {}));
}
BENCHMARK(weights_of_10000_nodes)->Unit(benchmark::kMillisecond);

void weights_without_a_grab(benchmark::State& state) {
  const Model& model = whole_sheet();
  const NodeSet selection = ten_thousand();
  for (auto _ : state) benchmark::DoNotOptimize(shape::compute_weights(model, selection, std::nullopt, {}));
}
BENCHMARK(weights_without_a_grab)->Unit(benchmark::kMillisecond);

void cut_10000_nodes(benchmark::State& state) {
  const Model& model = whole_sheet();
  const NodeSet selection = ten_thousand();
  for (auto _ : state) benchmark::DoNotOptimize(spatial::cut_patch_between(model, selection));
}
BENCHMARK(cut_10000_nodes)->Unit(benchmark::kMillisecond);

void geodesic_of_10000_nodes(benchmark::State& state) {
  const spatial::Patch patch = spatial::cut_patch_between(whole_sheet(), ten_thousand());
  const std::vector<std::uint32_t> source{5050};
  for (auto _ : state) benchmark::DoNotOptimize(spatial::geodesic_distance(patch, source));
}
BENCHMARK(geodesic_of_10000_nodes)->Unit(benchmark::kMillisecond);

/// All nodes within 250 mm of the middle, some 7,800.
NodeSet within_250_mm() {
  const Model& model = whole_sheet();
  const Vec3 middle = model.positions[500 * kSheetStride + 500];
  NodeSet nodes;
  for (std::size_t j = 440; j < 560; ++j)
    for (std::size_t i = 440; i < 560; ++i)
      if ((model.positions[j * kSheetStride + i] - middle).norm() <= 250) nodes.push_back(NodeIndex(j * kSheetStride + i));
  return nodes;
}

void cut_250_mm(benchmark::State& state) {
  const NodeSet nodes = within_250_mm();
  for (auto _ : state) benchmark::DoNotOptimize(spatial::cut_patch_between(whole_sheet(), nodes));
  state.counters["nodes"] = static_cast<double>(nodes.size());
}
BENCHMARK(cut_250_mm)->Unit(benchmark::kMillisecond);

void geodesic_of_250_mm(benchmark::State& state) {
  const NodeSet nodes = within_250_mm();
  const spatial::Patch patch = spatial::cut_patch_between(whole_sheet(), nodes);
  const auto middle = std::lower_bound(nodes.begin(), nodes.end(), NodeIndex(500 * kSheetStride + 500));
  const std::vector<std::uint32_t> source{static_cast<std::uint32_t>(middle - nodes.begin())};
  for (auto _ : state) benchmark::DoNotOptimize(spatial::geodesic_distance(patch, source));
}
BENCHMARK(geodesic_of_250_mm)->Unit(benchmark::kMillisecond);

/// The whole sheet, from its middle.
const spatial::Patch& whole_patch() {
  static const spatial::Patch patch = spatial::cut_patch(whole_sheet(), all_shells(whole_sheet()));
  return patch;
}
constexpr std::uint32_t kMiddle = 500 * kSheetStride + 500;

void geodesic_over_a_million_shells(benchmark::State& state) {
  const spatial::Patch& patch = whole_patch();
  const std::vector<std::uint32_t> source{kMiddle};
  for (auto _ : state) benchmark::DoNotOptimize(spatial::geodesic_distance(patch, source));
}
BENCHMARK(geodesic_over_a_million_shells)->Unit(benchmark::kMillisecond);

void plain_fast_marching_over_a_million_shells(benchmark::State& state) {
  const spatial::Patch& patch = whole_patch();
  for (auto _ : state) benchmark::DoNotOptimize(bench::plain_fast_marching(patch, kMiddle));
}
BENCHMARK(plain_fast_marching_over_a_million_shells)->Unit(benchmark::kMillisecond);

void tree_over_a_million_shells(benchmark::State& state) {
  const Model& model = whole_sheet();
  for (auto _ : state) benchmark::DoNotOptimize(spatial::ShellTree(model, all_shells(model)));
}
BENCHMARK(tree_over_a_million_shells)->Unit(benchmark::kMillisecond);

void closest_of_10000_points_on_a_million_shells(benchmark::State& state) {
  const Model& model = whole_sheet();
  const spatial::ShellTree tree(model, all_shells(model));
  for (auto _ : state)
    for (const NodeIndex node : ten_thousand()) benchmark::DoNotOptimize(tree.closest(model.position(node) + Vec3(0.4, 0.3, 2.0)));
}
BENCHMARK(closest_of_10000_points_on_a_million_shells)->Unit(benchmark::kMillisecond);

void oriented_normals_of_10000_nodes(benchmark::State& state) {
  const Model& model = whole_sheet();
  const NodeSet selection = ten_thousand();
  for (auto _ : state) benchmark::DoNotOptimize(shape::oriented_normals(model, selection, selection[5050]));
}
BENCHMARK(oriented_normals_of_10000_nodes)->Unit(benchmark::kMillisecond);

void nearest_node_of_a_million(benchmark::State& state) {
  const Model& model = whole_sheet();
  for (auto _ : state) benchmark::DoNotOptimize(select::nearest_node(model, Vec3(2500, 2500, 0)));
}
BENCHMARK(nearest_node_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void expression_over_a_million(benchmark::State& state) {
  const Model& model = whole_sheet();
  for (auto _ : state)
    benchmark::DoNotOptimize(select::evaluate(model, "1-9223372036854775807:10,!1-5000000:20,17-900000", select::EntityKind::node));
}
BENCHMARK(expression_over_a_million)->Unit(benchmark::kMillisecond);

void region_of_a_million(benchmark::State& state) {
  const Model& model = whole_sheet();
  for (auto _ : state)
    benchmark::DoNotOptimize(select::region(model, select::shells_at(model, NodeIndex(500 * kSheetStride + 500), {}),
                                            {select::RegionBound::features, 60, {}, nullptr}));
}
BENCHMARK(region_of_a_million)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prismesh::mesh
