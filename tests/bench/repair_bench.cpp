// Measures repairing a bump in a model of a million shells, where the cost follows the bump and not the model, and a model that is bad
// nearly everywhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include "mesh/model/adjacency.h"
#include "mesh/quality/report.h"
#include "mesh/repair/repair.h"
#include "tests/bench/million_quads.h"
#include "tests/mesh/repair/sheets.h"

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

/// Half the thickness of a NACA 0012 profile with a chord of 1 at `x` (Jacobs, Ward and Pinkerton, NACA report 460, 1933).
double half_thickness(double x) {
  return 5 * 0.12 * (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
}

/// A tapered wing of 3,744 triangles, around whose nose and tail they are thin.
Model triangulated_wing() {
  constexpr std::size_t kAround = 36, kAlong = 52;
  std::vector<Vec3> positions;
  std::vector<std::array<std::size_t, 4>> shells;
  for (std::size_t s = 0; s <= kAlong; ++s)
    for (std::size_t k = 0; k < kAround; ++k) {
      const double along = static_cast<double>(s) / kAlong, angle = 2 * std::numbers::pi * static_cast<double>(k) / kAround;
      const double x = (1 + std::cos(angle)) / 2, chord = 1000 - 600 * along;
      positions.emplace_back(300 * along + chord * x, chord * half_thickness(x) * (k <= kAround / 2 ? 1 : -1), 1800 * along);
    }
  for (std::size_t s = 0; s < kAlong; ++s)
    for (std::size_t k = 0; k < kAround; ++k) {
      const std::size_t a = s * kAround + k, b = s * kAround + (k + 1) % kAround;
      shells.push_back({a, b, b + kAround, b + kAround});
      shells.push_back({a, b + kAround, a + kAround, a + kAround});
    }
  return repair::model_of(positions, shells);
}

void repair_triangulated_wing(benchmark::State& state) {
  const Model wing = triangulated_wing();
  std::vector<double> edges;
  for (std::size_t s = 0; s < wing.shell_count(); ++s)
    for (std::size_t c = 0; c < 3; ++c)
      edges.push_back((wing.position(wing.shell_nodes[s].node[c]) - wing.position(wing.shell_nodes[s].node[(c + 1) % 3])).norm());
  std::nth_element(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2), edges.end());
  const double size = edges[edges.size() / 2];
  const auto judged = quality::judge_model(wing, {quality::default_criteria(), size});
  ShellSet scope;
  for (std::size_t s = 0; s < wing.shell_count(); ++s)
    if (judged[s].grade() != quality::Grade::ok) scope.push_back(ShellIndex(s));
  std::size_t left = 0;
  for (auto _ : state) {
    const relax::ReferenceSurface surface(wing, repair::all_shells(wing), 30);
    const auto repaired = repair::repair({wing, surface, {}, {quality::default_criteria(), size}, {}}, scope);
    left = repaired->unrepaired.size();
    benchmark::DoNotOptimize(repaired);
  }
  state.counters["damaged"] = static_cast<double>(scope.size());
  state.counters["left_failing"] = static_cast<double>(left);
}
BENCHMARK(repair_triangulated_wing)->Unit(benchmark::kMillisecond)->Iterations(1)->MeasureProcessCPUTime();

}  // namespace
}  // namespace prismesh::mesh
