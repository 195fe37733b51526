// Measures repairing a bump in a model of a million shells: the cost follows the bump, not the model.
#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>

#include "mesh/model/adjacency.h"
#include "mesh/quality/report.h"
#include "mesh/repair/repair.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh {
namespace {

struct Bump {
  Model model;
  ShellSet scope;
};

/// A bump of the given radius and height (in shells) in the middle of the sheet, and what it damaged.
Bump bump_of(double radius, double height) {
  const Model& flat = bench::million_quads();
  Bump bump{flat, {}};
  const auto before = quality::judge_model(flat, {quality::default_criteria(), 5.0});
  const Vec3 at = flat.position(NodeIndex(std::size_t{500 * 1001 + 500}));
  for (std::size_t n = 0; n < flat.node_count(); ++n) {
    const double d = 1 - (flat.positions[n] - at).norm() / (5 * radius);
    if (d > 0) bump.model.positions.set(n, flat.positions[n] + Vec3(0, 0, 5 * height * d * d * (3 - 2 * d)));
  }
  bump.model.node_holds.resize(flat.node_count());
  bump.model.node_ids.resize(flat.node_count());
  bump.model.midside = std::make_shared<const std::vector<MidsideNodes>>();
  bump.model.adjacency = std::make_shared<const Adjacency>(build_adjacency(bump.model));
  const auto after = quality::judge_model(bump.model, {quality::default_criteria(), 5.0});
  for (std::size_t s = 0; s < flat.shell_count(); ++s)
    if ((after[s].warn & ~before[s].warn) != 0) bump.scope.push_back(ShellIndex(s));
  return bump;
}

void repair_bump(benchmark::State& state) {
  const auto radius = static_cast<double>(state.range(0));
  const Bump bump = bump_of(radius, radius);
  std::size_t left = 0;
  for (auto _ : state) {
    ShellSet covered = bump.scope;
    for (int ring = 0; ring < 6; ++ring) covered = shells_touching(bump.model, nodes_of(bump.model, covered));
    const relax::ReferenceSurface surface(bump.model, covered, 30);
    const auto repaired = repair::repair({bump.model, surface, {}, {quality::default_criteria(), 5.0}, {}}, bump.scope);
    left = repaired->unrepaired.size();
    benchmark::DoNotOptimize(repaired);
  }
  state.counters["damaged"] = static_cast<double>(bump.scope.size());
  state.counters["left_failing"] = static_cast<double>(left);
}
BENCHMARK(repair_bump)->Arg(8)->Arg(35)->Unit(benchmark::kMillisecond)->Iterations(1)->MeasureProcessCPUTime();

}  // namespace
}  // namespace prismesh::mesh
