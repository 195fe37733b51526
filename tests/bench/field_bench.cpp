// Measures the tree of boxes and the bricks of the haptic pen: building, following an edit, pairs of bricks, closest points beside those of
// ShellTree. CPU times are those of all threads.
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include <benchmark/benchmark.h>

#include "mesh/field/brick.h"
#include "mesh/field/guides.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/box_tree.h"
#include "mesh/spatial/closest_point.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::field {
namespace {

double height(double x, double y) { return 300 * std::sin(x / 800) * std::cos(y / 900); }

/// Two curved, jittered layers of quads of 5 mm, 8 mm apart, `shells` in all.
Model layers(std::size_t shells) {
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(shells) / 2));
  const std::size_t stride = side + 1;
  Model m;
  m.positions.resize(2 * stride * stride, Vec3::Zero());
  m.shell_nodes.resize(2 * side * side);
  std::uint32_t seed = 1;
  const auto jitter = [&] { return ((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5; };
  for (std::size_t layer = 0; layer < 2; ++layer)
    for (std::size_t j = 0; j < stride; ++j)
      for (std::size_t i = 0; i < stride; ++i) {
        const double x = 5.0 * static_cast<double>(i), y = 5.0 * static_cast<double>(j);
        m.positions.set((layer * stride + j) * stride + i,
                        Vec3(x + 1.5 * jitter(), y + 1.5 * jitter(), height(x, y) + jitter() + 8.0 * static_cast<double>(layer)));
      }
  for (std::size_t layer = 0; layer < 2; ++layer)
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t i = 0; i < side; ++i) {
        const std::size_t a = (layer * stride + j) * stride + i;
        m.shell_nodes.set((layer * side + j) * side + i,
                          {{NodeIndex(a), NodeIndex(a + 1), NodeIndex(a + stride + 1), NodeIndex(a + stride)}});
      }
  m.adjacency = std::make_shared<const Adjacency>(build_adjacency(m));
  return m;
}

const Model& model_of(benchmark::State& state) {
  static std::map<std::int64_t, Model> models;
  auto& model = models[state.range(0)];
  if (model.node_count() == 0) model = layers(static_cast<std::size_t>(state.range(0)));
  return model;
}
const spatial::BoxTree& tree_of(benchmark::State& state) {
  static std::map<std::int64_t, spatial::BoxTree> trees;
  auto& tree = trees[state.range(0)];
  if (tree.empty()) tree = spatial::BoxTree(model_of(state));
  return tree;
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Arg(5'000'000)->UseRealTime()->MeasureProcessCPUTime();
}

void tree_is_built(benchmark::State& state) {
  const Model& model = model_of(state);
  std::size_t bytes = 0;
  for (auto _ : state) {
    const spatial::BoxTree tree(model);
    bytes = tree.bytes();
  }
  state.counters["bytes/shell"] = static_cast<double>(bytes) / static_cast<double>(model.shell_count());
}
BENCHMARK(tree_is_built)->Apply(sizes)->Unit(benchmark::kMillisecond);

/// 10,000 nodes move 0.5 mm up and down: neighbours, or each somewhere else.
void tree_follows(benchmark::State& state, bool scattered) {
  Model model = model_of(state);
  spatial::BoxTree tree = tree_of(state);
  const std::size_t step = scattered ? model.node_count() / 10'000 : 1;
  double sign = 0.5;
  std::size_t beside = 0;
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t n = 0; n < 10'000; ++n) {
      const std::size_t at = n * step % model.node_count();
      model.positions.set(at, model.positions[at] + Vec3(0, 0, sign));
    }
    sign = -sign;
    const spatial::BoxTree before = tree;
    state.ResumeTiming();
    tree.follow(model);
    state.PauseTiming();
    beside = tree.bytes_beside(before);
    state.ResumeTiming();
  }
  state.counters["MB beside"] = static_cast<double>(beside) * 1e-6;
}
BENCHMARK_CAPTURE(tree_follows, neighbours, false)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tree_follows, scattered, true)->Apply(sizes)->Unit(benchmark::kMillisecond);

Vec3 pen_at(const Model& model, std::size_t i) {
  const Vec3& node = model.positions[(model.node_count() / 3 + i * 7919) % model.node_count()];
  return node + Vec3(0.3, 0.2, 3.0 - static_cast<double>(i % 7));
}

using Bricks = std::array<std::unique_ptr<HapticBrick>, 2>;
Bricks two_bricks() { return {std::make_unique<HapticBrick>(), std::make_unique<HapticBrick>()}; }

field::Placement life_times(double scale) {
  field::Placement placement;
  placement.scale = scale;
  return placement;
}

/// Pairs of bricks of the pen at places all over the model, each from nothing; `scale` millimetres of the pen for one of the model.
void pairs_anywhere(benchmark::State& state, double scale) {
  const Model& model = model_of(state);
  const spatial::BoxTree& tree = tree_of(state);
  const field::Placement placement = life_times(scale);
  const Bricks bricks = two_bricks();
  std::size_t i = 0;
  for (auto _ : state) field::fill_bricks(tree, placement, placement.to_pen(pen_at(model, i++)), *bricks[0], *bricks[1]);
}
BENCHMARK_CAPTURE(pairs_anywhere, life_size, 1.0)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_anywhere, threefold, 3.0)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_anywhere, a_third, 0.3)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_anywhere, a_tenth, 0.1)->Apply(sizes)->Unit(benchmark::kMillisecond);

void guides_anywhere(benchmark::State& state, double scale) {
  const Model& model = model_of(state);
  const spatial::BoxTree& tree = tree_of(state);
  const field::Placement placement = life_times(scale);
  HapticGuides guides{};
  std::size_t i = 0;
  for (auto _ : state) field::find_guides(model, tree, placement, placement.to_pen(pen_at(model, i++)), guides);
}
BENCHMARK_CAPTURE(guides_anywhere, life_size, 1.0)->Apply(sizes)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides_anywhere, a_tenth, 0.1)->Apply(sizes)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(guides_anywhere, a_hundredth, 0.01)->Apply(sizes)->Unit(benchmark::kMicrosecond);

/// Pairs of bricks, 200 a second, of a pen that moves to and fro, 3 mm of the model over the surface, at a speed in mm/s; blocks are taken
/// over.
void pairs_on_the_way(benchmark::State& state, double scale, double speed) {
  const Model& model = model_of(state);
  const spatial::BoxTree& tree = tree_of(state);
  const field::Placement placement = life_times(scale);
  Bricks bricks = two_bricks(), before = two_bricks();
  const double way = speed / 200 / scale;  // of a step, in the model
  const Vec3& start = model.positions[model.node_count() / 5];
  double x = start.x() + 40, y = start.y() + 40, sign = 1;
  const auto pen_mm = [&] { return placement.to_pen(Vec3(x, y, height(x, y) + 3)); };
  field::fill_bricks(tree, placement, pen_mm(), *before[0], *before[1]);
  int steps = 0;
  for (auto _ : state) {
    if (++steps % 20 == 0) sign = -sign;
    x += sign * 0.8 * way;
    y += sign * 0.6 * way;
    const Vec3 pen = pen_mm();
    field::fill_bricks(tree, placement, pen, *bricks[0], *bricks[1], {before[0].get(), {}}, {before[1].get(), {}});
    std::swap(bricks, before);
  }
}
BENCHMARK_CAPTURE(pairs_on_the_way, life_size_at_200_mm_per_s, 1.0, 200.0)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_on_the_way, life_size_at_1500_mm_per_s, 1.0, 1500.0)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_on_the_way, a_tenth_at_200_mm_per_s, 0.1, 200.0)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs_on_the_way, a_tenth_at_1500_mm_per_s, 0.1, 1500.0)->Apply(sizes)->Unit(benchmark::kMillisecond);

template <class Tree>
void ask_points(benchmark::State& state, const Model& model, const Tree& tree, bool far) {
  std::size_t i = 0;
  for (auto _ : state) {
    for (int k = 0; k < 1000; ++k, ++i) benchmark::DoNotOptimize(tree.closest(pen_at(model, i) + Vec3(0, 0, far ? 60 : 0)));
  }
}
void closest_of_box_tree(benchmark::State& state) { ask_points(state, model_of(state), tree_of(state), state.range(1) != 0); }
void closest_of_shell_tree(benchmark::State& state) {
  const Model& model = model_of(state);
  ask_points(state, model, spatial::ShellTree(model, test::all_shells(model)), state.range(1) != 0);
}
BENCHMARK(closest_of_box_tree)
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {0, 1}})
    ->ArgNames({"shells", "far"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(closest_of_shell_tree)
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {0, 1}})
    ->ArgNames({"shells", "far"})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prismesh::mesh::field
