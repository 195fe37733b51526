// Measures the search for crossing shells, and for shells that are too close, in a million shells: one curved sheet, which has none, two
// sheets that wave, and two of which a bead of one goes through the other, which is separated.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/kept_contacts.h"
#include "mesh/contact/moved_shells.h"
#include "mesh/contact/new_contacts.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/contact/separate.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/report.h"
#include "mesh/spatial/box_tree.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::bench {
namespace {

Model with_its_adjacency(Model model) {
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

/// The upper half of the shells lies over the lower half, 5 mm or so away, and waves by 8 mm.
Model two_layers(double apart = 5) {
  Model model = million_quads();
  constexpr std::size_t kSide = 1000, kStride = kSide + 1;
  for (std::size_t s = kSide * kSide / 2; s < kSide * kSide; ++s) model.shell_parts.set(s, PartIndex(std::size_t{1}));
  for (std::size_t s = kSide * kSide / 2; s < kSide * kSide / 2 + kSide; ++s) model.shell_nodes.set(s, ShellNodes{});  // a gap
  for (std::size_t j = kStride / 2 + 1; j < kStride; ++j)
    for (std::size_t i = 0; i < kStride; ++i) {
      const Vec3& below = model.positions[(j - kStride / 2 - 1) * kStride + i];
      model.positions.set(j * kStride + i, below + Vec3(1.3, 2.1, apart + 8 * std::sin(below.x() / 90) * std::cos(below.y() / 110)));
    }
  return model;
}

void find_no_crossing(benchmark::State& state) {
  const Model model = with_its_adjacency(million_quads());
  const spatial::BoxTree tree(model);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(contact::find_perforations(model, tree));
}
BENCHMARK(find_no_crossing)->Unit(benchmark::kMillisecond)->UseRealTime();

void find_crossings(benchmark::State& state) {
  const Model model = with_its_adjacency(two_layers());
  const spatial::BoxTree tree(model);
  std::size_t regions = 0, pairs = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto found = contact::find_perforations(model, tree);
    regions = found.size(), pairs = 0;
    for (const contact::Perforation& perforation : found) pairs += perforation.crossings.size();
  }
  state.counters["regions"] = static_cast<double>(regions);
  state.counters["pairs"] = static_cast<double>(pairs);
}
BENCHMARK(find_crossings)->Unit(benchmark::kMillisecond)->UseRealTime();

void find_depths(benchmark::State& state) {
  const Model model = with_its_adjacency(two_layers());
  const spatial::BoxTree tree(model);
  const auto found = contact::find_perforations(model, tree);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(contact::perforation_depths(model, tree, found, 0));
}
BENCHMARK(find_depths)->Unit(benchmark::kMillisecond)->UseRealTime();

void search_penetrations(benchmark::State& state, const Model& model, double of_all) {
  const spatial::BoxTree tree(model);
  const contact::ContactThickness thickness = contact::given_thickness(model, of_all);
  const auto crossings = contact::find_shell_crossings(model, tree);
  std::size_t regions = 0, pairs = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto found = contact::find_penetrations(model, tree, thickness, crossings);
    regions = found.size(), pairs = 0;
    for (const contact::Penetration& region : found) pairs += region.pairs.size();
  }
  state.counters["regions"] = static_cast<double>(regions);
  state.counters["pairs"] = static_cast<double>(pairs);
}
/// Of one sheet, 1 mm and 8 mm thick with shells of 5 mm: there are none.
void find_no_penetration(benchmark::State& state) { search_penetrations(state, with_its_adjacency(million_quads()), 1); }
BENCHMARK(find_no_penetration)->Unit(benchmark::kMillisecond)->UseRealTime();
void find_no_penetration_of_thick_shells(benchmark::State& state) { search_penetrations(state, with_its_adjacency(million_quads()), 8); }
BENCHMARK(find_no_penetration_of_thick_shells)->Unit(benchmark::kMillisecond)->UseRealTime();
/// Two layers, 2 to 18 mm apart.
void find_penetrations(benchmark::State& state) { search_penetrations(state, with_its_adjacency(two_layers(10)), 3); }
BENCHMARK(find_penetrations)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A step of a drag of the nodes about the middle of the lower of two layers, 12 to 28 mm apart: up by 19 mm, where most of its shells
/// touch the upper one, and back. A million shells of 3 mm.
void step_of_a_drag(benchmark::State& state) {
  const Model model = with_its_adjacency(two_layers(20));
  const spatial::BoxTree tree(model);
  const auto thickness = std::make_shared<const contact::ContactThickness>(contact::given_thickness(model, 3));
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(state.range(0))));
  constexpr std::size_t kStride = 1001;
  NodeSet nodes;
  std::vector<Vec3> at[2];
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      nodes.emplace_back((250 - side / 2 + j) * kStride + 500 - side / 2 + i);
      at[0].push_back(model.position(nodes.back()));
      at[1].push_back(at[0].back() + Vec3(0, 0, 19));
    }
  contact::MovedShells moved(model, tree, thickness, nodes, shells_touching(model, nodes));
  std::size_t step = 0, touches = 0;
  for ([[maybe_unused]] auto _ : state) touches = std::max(touches, moved.at(at[++step % 2]).size());
  state.counters["nodes"] = static_cast<double>(nodes.size());
  state.counters["touches"] = static_cast<double>(touches);
}
BENCHMARK(step_of_a_drag)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime();
/// What the first step of a drag waits for: the tree, the thickness, and what touches before.
void begin_a_drag(benchmark::State& state) {
  const Model model = with_its_adjacency(two_layers(20));
  for ([[maybe_unused]] auto _ : state) {
    const spatial::BoxTree tree(model);
    const auto thickness = std::make_shared<const contact::ContactThickness>(contact::section_thickness(model));
    const NodeSet nodes{NodeIndex(std::size_t{250'000})};
    benchmark::DoNotOptimize(contact::MovedShells(model, tree, thickness, nodes, shells_touching(model, nodes)));
  }
}
BENCHMARK(begin_a_drag)->Unit(benchmark::kMillisecond)->UseRealTime();

/// The search after an edit of nodes about the middle of the lower layer, up by 1 mm and back, with what was found before. Shells of 1 mm
/// in one sheet without contacts; of 3 mm in two layers, 2 to 18 mm apart, that are too close in 86 regions; and of two that cross in 74.
void search_after_an_edit(benchmark::State& state, Model model, double thick) {
  contact::KeptContacts kept;
  spatial::BoxTree tree(model);
  const auto thickness = std::make_shared<const contact::ContactThickness>(contact::given_thickness(model, thick));
  if (!kept.search({model, tree, thickness, 0})) state.SkipWithError("stopped");
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(state.range(0))));
  Model moved = model;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const std::size_t node = (250 - side / 2 + j) * 1001 + 500 - side / 2 + i;
      moved.positions.set(node, model.positions[node] + Vec3(0, 0, 1));
    }
  std::size_t step = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Model& next = ++step % 2 == 0 ? model : moved;
    tree.follow(next);
    if (!kept.search({next, tree, thickness, 0})) state.SkipWithError("stopped");
  }
  state.counters["regions"] = static_cast<double>(kept.perforations().size() + kept.penetrations().size());
}
void search_one_sheet_after_an_edit(benchmark::State& state) { search_after_an_edit(state, with_its_adjacency(million_quads()), 1); }
BENCHMARK(search_one_sheet_after_an_edit)->Arg(100)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
void search_close_layers_after_an_edit(benchmark::State& state) { search_after_an_edit(state, with_its_adjacency(two_layers(10)), 3); }
BENCHMARK(search_close_layers_after_an_edit)->Arg(100)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
void search_crossing_layers_after_an_edit(benchmark::State& state) { search_after_an_edit(state, with_its_adjacency(two_layers()), 3); }
BENCHMARK(search_crossing_layers_after_an_edit)
    ->Arg(100)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// What a rule asks of an edit: its new contacts. Nodes about the middle of the lower of two layers, 12 to 28 mm apart, up by 8 mm, where
/// nothing touches. A pull that stops asks eleven times.
void find_new_contacts(benchmark::State& state) {
  const Model model = with_its_adjacency(two_layers(20));
  const contact::ContactsBefore before(model, spatial::BoxTree(model),
                                       std::make_shared<const contact::ContactThickness>(contact::given_thickness(model, 3)));
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(state.range(0))));
  Model moved = model;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const std::size_t node = (250 - side / 2 + j) * 1001 + 500 - side / 2 + i;
      moved.positions.set(node, model.positions[node] + Vec3(0, 0, 8));
    }
  std::size_t found = 0;
  for ([[maybe_unused]] auto _ : state) found = before.new_in(moved).size();
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(find_new_contacts)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

/// Two smooth layers, 10 mm apart; a bead of the upper one is pulled through the lower one by 2 mm. Smooth, as rough shells fail when they
/// are moved at all.
Model bead_through_layer() {
  Model model = two_layers();
  constexpr std::size_t kStride = 1001, kFirstAbove = kStride / 2 + 1, kColumn = 500, kRow = kFirstAbove + 250;
  const auto place = [](double x, double y) { return Vec3(x, y, 300 * std::sin(x / 800) * std::cos(y / 900)); };
  for (std::size_t j = 0; j < kStride; ++j)
    for (std::size_t i = 0; i < kStride; ++i) {
      const double x = 5.0 * static_cast<double>(i), y = 5.0 * static_cast<double>(j < kFirstAbove ? j : j - kFirstAbove);
      const double r2 = (Vec3(x, y, 0) - Vec3(5.0 * kColumn, 5.0 * (kRow - kFirstAbove), 0)).squaredNorm();
      const Vec3 above(1.3, 2.1, 10 - 12 * std::exp(-r2 / (20 * 20)));
      model.positions.set(j * kStride + i, j < kFirstAbove ? place(x, y) : Vec3(place(x, y) + above));
    }
  return model;
}

struct BeadToSeparate {
  Model model = with_its_adjacency(bead_through_layer());
  spatial::BoxTree tree{model};
  contact::ContactThickness thickness = contact::given_thickness(model, 1.5);
  quality::SizedCriteria criteria{quality::default_criteria(), 5};
  ChunkedArray<quality::ShellState> states = quality::judge_model(model, criteria);
};

void find_bead(benchmark::State& state) {
  const BeadToSeparate bead;
  std::size_t regions = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto crossings = contact::find_shell_crossings(bead.model, bead.tree);
    const auto penetrations = contact::find_penetrations(bead.model, bead.tree, bead.thickness, crossings);
    regions = contact::group_crossings(bead.model, crossings).size() + penetrations.size();
  }
  state.counters["regions"] = static_cast<double>(regions);
}
BENCHMARK(find_bead)->Unit(benchmark::kMillisecond)->UseRealTime();

void separate_bead(benchmark::State& state) {
  const BeadToSeparate bead;
  contact::Separation done;
  for ([[maybe_unused]] auto _ : state)
    if (auto separated = contact::separate(
            {bead.model, bead.tree, bead.thickness, bead.criteria, bead.states, {}, [](NodeIndex) { return std::string_view(); }}, {}))
      done = std::move(*separated);
  state.counters["removed"] = static_cast<double>(done.removed());
  if (!done.left.empty()) state.SetLabel(done.left.front().why);
  state.counters["moved"] = static_cast<double>(done.nodes.size());
}
BENCHMARK(separate_bead)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh::bench
