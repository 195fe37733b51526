// Measures the list of parts: laying it out while it scrolls, following a newer generation, counting errors. Limit: 2 ms a layout.
#include <memory>
#include <random>
#include <string>

#include <benchmark/benchmark.h>
#include <imgui.h>

#include "kiosk/display/headless.h"
#include "kiosk/panels/gui.h"
#include "kiosk/panels/layout.h"
#include "kiosk/tools/parts/part_errors.h"
#include "kiosk/tools/parts/part_list.h"
#include "tests/kiosk/test_source.h"

namespace {

using namespace prismesh;
using namespace prismesh::kiosk;
using namespace prismesh::kiosk::tools::parts;

constexpr int kParts = 5000;

/// Parts of 20 files with names as a car has them.
PartFacts facts() {
  PartFacts facts;
  facts.files.resize(20);
  std::mt19937 random(3);
  for (int i = 0; i < kParts; ++i) {
    PartRow row;
    row.id = 2'000'000 + i;
    row.name = "FRT_BUMPER_REINFORCEMENT_INNER_" + std::to_string(random() % 10'000);
    row.shells = random() % 20'000;
    row.errors = {static_cast<std::uint32_t>(random() % 50), static_cast<std::uint32_t>(random() % 3)};
    facts.parts.push_back(row);
    facts.files[static_cast<std::size_t>(i) % 20].parts.push_back(row.id);
  }
  for (std::size_t f = 0; f < 20; ++f) facts.files[f].name = "include_" + std::to_string(f) + ".k";
  return facts;
}

/// A layout of the list in a dock, as it scrolls by a few rows. Argument: whether a filter is set.
void layout_of_5000_parts(benchmark::State& state) {
  display::Headless headless = std::move(*display::Headless::create());
  panels::Gui gui = std::move(*panels::Gui::create());
  (void)gui.set_type(panels::kFlatType);
  PartTree tree;
  tree.set_facts(facts());
  if (state.range(0) != 0) tree.set_filter("bump");
  constexpr display::PixelSize kPicture{1920, 1080};
  gui.feed(display::PointerMoved{200, 800, {}});
  for (auto _ : state) {
    gui.feed(display::WheelTurned{-1, 200, 800, {}});
    panels::PanelLayout layout{kPicture};
    gui.layout(kPicture, 0.016, [&] {
      panels::begin_docked("Dock", {0, 0, 312, 1000});
      benchmark::DoNotOptimize(part_list(tree, layout));
      ImGui::End();
    });
  }
}
BENCHMARK(layout_of_5000_parts)->ArgName("filter")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// Once for each generation and each sign typed into the filter.
void rows_of_5000_parts(benchmark::State& state) {
  PartTree tree;
  tree.set_facts(facts());
  tree.sort(SortBy::name);
  for (auto _ : state) tree.set_filter(tree.filter().empty() ? "bump" : "");
}
BENCHMARK(rows_of_5000_parts)->Unit(benchmark::kMillisecond);

/// Argument: chunks that have changed since the last count; 0: all, a deck just opened.
void errors_of_a_million_shells(benchmark::State& state) {
  test::TestSource source;
  test::add_grid(source, 1000, 1000, 0, [](double u, double v) { return mesh::Vec3(u, v, 0); });
  source.hidden.resize(kParts);
  for (std::size_t s = 0; s < source.shell_parts.size(); ++s) {
    source.shell_parts[s] = mesh::PartIndex(s * kParts / source.shell_parts.size());
    if (s % 20 == 0) source.shell_quality[s] = {1 << 5, 0};
  }
  PartErrors errors;
  errors.count(source);
  for (auto _ : state) {
    state.PauseTiming();
    if (state.range(0) == 0) ++source.key;
    for (std::size_t c = 0; c < static_cast<std::size_t>(state.range(0)); ++c) source.touch(ipc::SnapshotArray::shell_quality, c);
    state.ResumeTiming();
    benchmark::DoNotOptimize(errors.count(source));
  }
}
BENCHMARK(errors_of_a_million_shells)->ArgName("changed_chunks")->Arg(0)->Arg(1)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
