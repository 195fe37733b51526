// Measures edits of a document of a million shells: each cost must follow the change, not the model.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "mesh/document/document.h"
#include "mesh/document/drag.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_report.h"
#include "mesh/document/generation.h"
#include "mesh/document/journal.h"
#include "mesh/document/prepare.h"
#include "mesh/document/selection.h"
#include "tests/bench/million_document.h"

namespace prismesh::mesh::document {
namespace {

Document& million() {
  static Document document = [] {
    Document fresh = bench::open_million();
    const Result<EditReport> selected = document::apply(fresh, Edit(Select{bench::patch_expression()}));
    if (!selected || fresh.current().selected_nodes != 10'000) {
      std::cerr << "the patch isn't 10,000 nodes: " << (selected ? "" : selected.error().text()) << '\n';
      std::abort();
    }
    return fresh;
  }();
  return document;
}

Edit pull(double z) {
  Translate translate;
  translate.by = Vec3(0, 0, z);
  return translate;
}

void generation_copy(benchmark::State& state) {
  const Document& document = million();
  for (auto _ : state) {
    Generation copy = document.current();
    benchmark::DoNotOptimize(copy);
  }
}
BENCHMARK(generation_copy)->Unit(benchmark::kMicrosecond);

void selection_of_10k(benchmark::State& state) {
  const Document& document = million();
  for (auto _ : state) benchmark::DoNotOptimize(selected_nodes(document.current()));
}
BENCHMARK(selection_of_10k)->Unit(benchmark::kMicrosecond);

void translate_10k(benchmark::State& state) {
  const Document& document = million();
  for (auto _ : state) {
    const Result<Prepared> prepared = prepare(document, pull(1.5));
    if (!prepared) return state.SkipWithError(prepared.error().text().c_str());
    benchmark::DoNotOptimize(prepared);
  }
}
BENCHMARK(translate_10k)->Unit(benchmark::kMillisecond);

/// An edit that names its 586 nodes while many others are selected: it must follow what moves.
void translate_586_beside_a_selection(benchmark::State& state) {
  Document document = million();
  const Result<EditReport> selected = document::apply(document, Edit(Select{"1-" + std::to_string(state.range(0))}));
  if (!selected) return state.SkipWithError(selected.error().text().c_str());
  Translate translate;
  translate.by = Vec3(0, 0, 1.5);
  translate.shaping.on = "500000-500585";
  for (auto _ : state) {
    const Result<Prepared> prepared = prepare(document, translate);
    if (!prepared) return state.SkipWithError(prepared.error().text().c_str());
    benchmark::DoNotOptimize(prepared);
  }
}
BENCHMARK(translate_586_beside_a_selection)->Arg(1'000)->Arg(100'000)->Unit(benchmark::kMillisecond);

/// A drag of the patch in the middle of the million quads. `symmetric`: about a plane beside the patch, which doubles what moves.
Edit drag_of(const char* kind, bool symmetric) {
  Edit edit = parse_edit(std::string("{") + kind + "}").value();
  if (symmetric) shaping_of(edit)->symmetry = Symmetry{Vec3(2500, 0, 0), Vec3::UnitX()};
  return edit;
}

void drag_begin_10k(benchmark::State& state, const char* kind, bool symmetric) {
  const Document& document = million();
  const Edit edit = drag_of(kind, symmetric);
  for (auto _ : state) {
    Result<Drag> drag = Drag::begin(document.generations[document.cursor], edit);
    if (!drag) return state.SkipWithError(drag.error().text().c_str());
    benchmark::DoNotOptimize(drag);
  }
}

void drag_step_10k(benchmark::State& state, const char* kind, bool symmetric) {
  const Document& document = million();
  Result<Drag> drag = Drag::begin(document.generations[document.cursor], drag_of(kind, symmetric));
  if (!drag) return state.SkipWithError(drag.error().text().c_str());
  double size = 0;
  for (auto _ : state) {
    drag->step({Vec3(0.6, 0.7, 0.1) * size, size, size});
    benchmark::DoNotOptimize(drag->states().data());
    size = size < 20 ? size + 0.05 : 0;  // as a hand moves: up to some elements far
  }
  state.counters["nodes"] = static_cast<double>(drag->nodes().size());
  state.counters["shells"] = static_cast<double>(drag->shells().size());
}

constexpr const char* kTranslate = R"("edit":"translate","by":[0,0,0])";
constexpr const char* kLift = R"("edit":"lift","distance":0)";
constexpr const char* kLiftEach = R"("edit":"lift","distance":0,"normals":"each")";
constexpr const char* kRotate = R"("edit":"rotate","point":[2500,2500,0],"axis":[0.2,1,0],"degrees":0)";
constexpr const char* kSlide = R"("edit":"slide","by":[0,0,0])";
#define BENCHMARK_DRAG(name, kind, symmetric)                                                             \
  BENCHMARK_CAPTURE(drag_begin_10k, name, kind, symmetric)->Unit(benchmark::kMillisecond)->UseRealTime(); \
  BENCHMARK_CAPTURE(drag_step_10k, name, kind, symmetric)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()
BENCHMARK_DRAG(translate, kTranslate, false);
BENCHMARK_DRAG(lift, kLift, false);
BENCHMARK_DRAG(lift_each, kLiftEach, false);
BENCHMARK_DRAG(rotate, kRotate, false);
BENCHMARK_DRAG(slide, kSlide, false);
BENCHMARK_DRAG(translate_symmetric, kTranslate, true);
BENCHMARK_DRAG(slide_symmetric, kSlide, true);
#undef BENCHMARK_DRAG

void undo_redo_10k(benchmark::State& state) {
  Document document = million();
  if (const Result<EditReport> pulled = document::apply(document, pull(1.5)); !pulled) return state.SkipWithError("pull");
  for (auto _ : state) {
    benchmark::DoNotOptimize(document::apply(document, Edit(Undo{})));
    benchmark::DoNotOptimize(document::apply(document, Edit(Redo{})));
  }
}
BENCHMARK(undo_redo_10k)->Unit(benchmark::kMicrosecond);

void select_one(benchmark::State& state) {
  const Document& document = million();
  for (auto _ : state) benchmark::DoNotOptimize(prepare(document, Edit(Select{"500000"})));
}
BENCHMARK(select_one)->Unit(benchmark::kMicrosecond);

void lock_a_part(benchmark::State& state) {
  const Document& document = million();
  for (auto _ : state) benchmark::DoNotOptimize(prepare(document, Edit(SetParts{VisibilityAction::lock, "all"})));
}
BENCHMARK(lock_a_part)->Unit(benchmark::kMillisecond);

void journal_translate_10k(benchmark::State& state) {
  Document document = bench::open_million();
  const auto path = std::filesystem::temp_directory_path() / ("document-bench-" + std::to_string(::getpid()) + ".journal");
  Result<Journal> journal = Journal::create(path, document);
  if (!journal) return state.SkipWithError(journal.error().text().c_str());
  const Edit select = Select{bench::patch_expression()};
  document::apply(document, select).value();
  const Edit edit = pull(1.5);
  const Result<Prepared> prepared = prepare(document, edit);
  for (auto _ : state)
    if (!journal->append(document, edit, *prepared)) return state.SkipWithError("append");
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(path)) / static_cast<double>(state.iterations());
  std::filesystem::remove(path);
}
BENCHMARK(journal_translate_10k)->Unit(benchmark::kMillisecond)->Iterations(50);

}  // namespace
}  // namespace prismesh::mesh::document
