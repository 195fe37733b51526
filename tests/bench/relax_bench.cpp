// Measures relaxing: 1,000 elements in full and from a node, and a million shells.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "mesh/model/adjacency.h"
#include "mesh/relax/relax.h"
#include "tests/bench/million_quads.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::bench {

namespace {

using test::all_nodes;
using test::all_shells;

double height(double x, double y) { return 40 * std::sin(x / 90) + 25 * std::cos(y / 120); }

/// Relaxing knows by its id which node is which of the surface.
void number_nodes(Model& model) {
  model.node_ids.resize(model.node_count());
  for (std::size_t n = 0; n < model.node_count(); ++n) model.node_ids.set(n, static_cast<std::int64_t>(n) + 1);
}

/// A bumper-like panel of columns x rows quads of 10 mm, its inner nodes put out of place by up to `jitter_mm` in it.
Model panel(std::size_t columns, std::size_t rows, double jitter_mm) {
  Model m;
  m.positions.resize((columns + 1) * (rows + 1), Vec3::Zero());
  m.node_holds.resize(m.positions.size());
  number_nodes(m);
  m.shell_nodes.resize(columns * rows);
  m.shell_parts.resize(columns * rows, PartIndex(std::size_t{0}));
  m.shell_thickness.resize(columns * rows);
  std::uint32_t seed = 1;
  const auto jitter = [&] { return ((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5; };
  for (std::size_t j = 0; j <= rows; ++j)
    for (std::size_t i = 0; i <= columns; ++i) {
      const bool inside = i > 0 && j > 0 && i < columns && j < rows;
      const double x = 10.0 * static_cast<double>(i) + (inside ? 2 * jitter_mm * jitter() : 0),
                   y = 10.0 * static_cast<double>(j) + (inside ? 2 * jitter_mm * jitter() : 0);
      m.positions.set(j * (columns + 1) + i, Vec3(x, y, height(x, y)));
    }
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t a = j * (columns + 1) + i, d = a + columns + 1;
      m.shell_nodes.set(j * columns + i, {{NodeIndex(a), NodeIndex(a + 1), NodeIndex(d + 1), NodeIndex(d)}});
    }
  m.parts = std::make_shared<const std::vector<Part>>(1);
  m.adjacency = std::make_shared<const Adjacency>(build_adjacency(m));
  return m;
}

void say(const relax::Relaxed& relaxed, benchmark::State& state) {
  state.counters["rounds"] = relaxed.rounds;
  state.counters["moved"] = static_cast<double>(relaxed.nodes.size());
  state.counters["held_back"] = static_cast<double>(relaxed.held_back);
  state.counters["converged"] = relaxed.converged ? 1 : 0;
}

void relax_thousand(benchmark::State& state) {
  const Model model = panel(40, 25, 3);
  const NodeSet nodes = all_nodes(model);
  const ShellSet shells = all_shells(model);
  for (auto _ : state) {
    const relax::ReferenceSurface surface(model, shells, 30);
    say(relax::relax({model, surface, {quality::default_criteria(), 10}, {}}, nodes).value(), state);
  }
}
BENCHMARK(relax_thousand)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// One node pulled 5 mm to the side in a good mesh of 1,000 elements; neighbours join beyond 0.5 mm.
void relax_thousand_from(benchmark::State& state) {
  Model model = panel(40, 25, 0);
  const std::size_t pulled = 12 * 41 + 20;
  const double x = 10 * 20 + 5;
  model.positions.set(pulled, Vec3(x, 120, height(x, 120)));
  const NodeSet nodes = all_nodes(model);
  const ShellSet shells = all_shells(model);
  for (auto _ : state) {
    const relax::ReferenceSurface surface(model, shells, 30);
    say(relax::relax_from({model, surface, {quality::default_criteria(), 10}, {}}, {NodeIndex(pulled), 0.5}, nodes).value(), state);
  }
}
BENCHMARK(relax_thousand_from)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void relax_million(benchmark::State& state) {
  Model model = million_quads();
  model.node_holds.resize(model.node_count());
  number_nodes(model);
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  const NodeSet nodes = all_nodes(model);
  const ShellSet shells = all_shells(model);
  for (auto _ : state) {
    const relax::ReferenceSurface surface(model, shells, 30);
    int heard = 0;
    double longest_ms = 0;
    auto last = std::chrono::steady_clock::now();
    const auto hear = [&](double) {
      const auto now = std::chrono::steady_clock::now();
      longest_ms = std::max(longest_ms, std::chrono::duration<double, std::milli>(now - last).count());
      last = now;
      return ++heard > 0;
    };
    say(relax::relax({model, surface, {quality::default_criteria(), 5}, {}}, nodes, hear).value(), state);
    state.counters["progress_calls"] = heard;
    state.counters["longest_between_ms"] = longest_ms;
  }
}
BENCHMARK(relax_million)->Unit(benchmark::kSecond)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

}  // namespace prismesh::mesh::bench
