// Measures selections on a million shells: outlines, visible nodes, regions.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/connections/find_joined_sheets.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/loops.h"
#include "mesh/select/outline.h"
#include "mesh/select/region.h"
#include "mesh/select/visible.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh {
namespace {

constexpr std::size_t kStride = 1001;
using Outline = std::vector<std::array<double, 2>>;

Model with_indices(Model model) {
  std::vector<std::int64_t> ids(model.node_count());
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int64_t>(i + 1);
  model.node_holds.resize(model.node_count());
  model.node_index = std::make_shared<IdIndex>(ids);
  ids.resize(model.shell_count());
  model.shell_index = std::make_shared<IdIndex>(ids);
  model.midside = std::make_shared<std::vector<MidsideNodes>>();
  for (std::size_t c = 1; c < model.elements.size(); ++c) model.elements[c] = std::make_shared<ElementBlock>();
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

const Model& whole() {
  static const Model model = with_indices(bench::million_quads());
  return model;
}

/// The same million shells as 25 tiles of 200 x 200, one behind the other, 12 apart: as deep as a car seen from the side.
const Model& stacked() {
  static const Model model = [] {
    Model stack = bench::million_quads();
    const auto tile_of = [](std::size_t i, std::size_t j) { return std::pair(i / 200, j / 200); };
    for (std::size_t j = 0; j < kStride; ++j)
      for (std::size_t i = 0; i < kStride; ++i) {
        const auto [column, row] = tile_of(i, j);
        Vec3 p = stack.positions[j * kStride + i];
        p.x() -= 1000.0 * static_cast<double>(column);
        p.y() -= 1000.0 * static_cast<double>(row);
        p.z() = 0.1 * p.z() - 12.0 * static_cast<double>(5 * row + column);
        stack.positions.set(j * kStride + i, p);
      }
    for (std::size_t j = 0; j < 1000; ++j)
      for (std::size_t i = 0; i < 1000; ++i)
        if (tile_of(i, j) != tile_of(i + 1, j + 1)) {
          const NodeIndex corner(j * kStride + i);
          stack.shell_nodes.set(j * 1000 + i, {{corner, corner, corner, corner}});
        }
    return with_indices(stack);
  }();
  return model;
}

/// A lasso of 256 corners with an irregular border.
Outline wild_outline() {
  Outline outline;
  for (int k = 0; k < 256; ++k) {
    const double t = 2 * 3.14159265358979 * k / 256;
    const double r = 0.5 + 0.2 * std::sin(5 * t) + 0.05 * std::cos(31 * t);
    outline.push_back({r * std::cos(t), r * std::sin(t)});
  }
  return outline;
}

const Outline kWholePicture{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/// The plate of 5 m fills the picture.
constexpr double kScale = 1.0 / 2500;
constexpr std::array<double, 16> kView{kScale, 0, 0, 0, 0, kScale, 0, 0, 0, 0, -kScale / 4, 0, -1, -1, 0, 1};
/// A tile of the stack fills the picture.
constexpr std::array<double, 16> kStackView{5 * kScale, 0, 0, 0, 0, 5 * kScale, 0, 0, 0, 0, -kScale / 4, 0, -1, -1, 0, 1};

void outline_of_256_corners(benchmark::State& state) {
  const Outline outline = wild_outline();
  for (auto _ : state) benchmark::DoNotOptimize(select::inside_outline(whole(), kView, outline));
}
BENCHMARK(outline_of_256_corners)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// The same without bands, for comparison: every node against every side, on one core.
void outline_of_256_corners_naively(benchmark::State& state) {
  const Outline outline = wild_outline();
  const Model& model = whole();
  for (auto _ : state) {
    NodeSet nodes;
    for (std::size_t i = 0; i < model.node_count(); ++i) {
      const double x = kScale * model.positions[i].x() - 1, y = kScale * model.positions[i].y() - 1;
      int winding = 0;
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const auto& a = outline[k];
        const auto& b = outline[(k + 1) % outline.size()];
        const double cross = (b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1]);
        if (a[1] <= y && y < b[1] && cross > 0) ++winding;
        if (b[1] <= y && y < a[1] && cross < 0) --winding;
      }
      if (winding != 0) nodes.push_back(NodeIndex(i));
    }
    benchmark::DoNotOptimize(nodes);
  }
}
BENCHMARK(outline_of_256_corners_naively)->Unit(benchmark::kMillisecond);

void visible(benchmark::State& state, const Model& model, const std::array<double, 16>& view, const Outline& outline) {
  const NodeSet candidates = select::inside_outline(model, view, outline);
  std::size_t seen = 0;
  for (auto _ : state) seen = select::visible_nodes(model, view, candidates, {})->size();
  state.counters["candidates"] = static_cast<double>(candidates.size());
  state.counters["visible"] = static_cast<double>(seen);
}
BENCHMARK_CAPTURE(visible, lasso_on_a_sheet, whole(), kView, wild_outline())
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(visible, whole_sheet, whole(), kView, kWholePicture)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(visible, lasso_on_25_layers, stacked(), kStackView, wild_outline())
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(visible, all_of_25_layers, stacked(), kStackView, kWholePicture)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

ShellSet middle() { return select::shells_at(whole(), NodeIndex(500 * kStride + 500), {}); }

void region_by_features(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(select::region(whole(), middle(), {select::RegionBound::features, 60, {}, nullptr}));
}
BENCHMARK(region_by_features)->Unit(benchmark::kMillisecond);

void region_by_part(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(select::region(whole(), middle(), {select::RegionBound::part, 60, {}, nullptr}));
}
BENCHMARK(region_by_part)->Unit(benchmark::kMillisecond);

void region_by_piece(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(select::region(whole(), middle(), {select::RegionBound::piece, 60, {}, nullptr}));
}
BENCHMARK(region_by_piece)->Unit(benchmark::kMillisecond);

void region_across_welds(benchmark::State& state) {
  for (auto _ : state) {
    const connections::JoinedSheets welds = connections::find_joined_sheets(whole(), {}, {});
    benchmark::DoNotOptimize(select::region(whole(), middle(), {select::RegionBound::features, 60, {}, &welds}));
  }
}
BENCHMARK(region_across_welds)->Unit(benchmark::kMillisecond);

/// From the middle, as far from a free edge as can be.
void free_edge_loop_from_the_middle(benchmark::State& state) {
  const Vec3 place = whole().positions[500 * kStride + 500];
  for (auto _ : state) benchmark::DoNotOptimize(select::free_edge_loop(whole(), middle(), place, {}));
}
BENCHMARK(free_edge_loop_from_the_middle)->Unit(benchmark::kMillisecond);

void shells_near_a_point(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(select::shells_near(whole(), Vec3(2500, 2500, 0), {}));
}
BENCHMARK(shells_near_a_point)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh
