// Measures what the model server computes of a million shells for a view: the quality panel's figures, a bar's shells, fields.
#include <benchmark/benchmark.h>

#include "ipc/model/messages_json.h"
#include "mesh/document/field.h"
#include "mesh/document/field_wish.h"
#include "mesh/document/make_field.h"
#include "mesh/document/prepare.h"
#include "mesh/document/quality_figures.h"
#include "tests/bench/million_document.h"

namespace {

using namespace prismesh;
using mesh::document::Document;

const Document& million() {
  static const Document document = [] {
    Document opened = mesh::bench::open_million();
    mesh::document::Translate lift;
    lift.by = {0, 0, 4};
    lift.shaping.on = mesh::bench::patch_expression();
    (void)mesh::document::apply(opened, lift);
    return opened;
  }();
  return document;
}

/// The panel's figures, put into a line of JSON. Arguments: with a histogram, of the damaged shells only.
void quality_figures_of_a_million(benchmark::State& state) {
  const ipc::GetQuality request{state.range(0) != 0 ? "warpage" : "", state.range(1) != 0};
  std::size_t errors = 0, bytes = 0;
  for (auto _ : state) {
    const ipc::Quality quality = mesh::document::quality_figures(million(), request).value();
    errors = quality.error_count;
    bytes = ipc::encode_answer(1, quality, 0).size();
  }
  state.counters["errors"] = static_cast<double>(errors);
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(quality_figures_of_a_million)
    ->ArgNames({"histogram", "damaged"})
    ->Args({0, 0})
    ->Args({1, 0})
    ->Args({0, 1})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The shells of a bar that holds about half of them.
void shells_of_a_bar_of_a_million(benchmark::State& state) {
  ipc::FindShells request;
  request.metric = "warpage";
  request.from = 3;
  for (auto _ : state) benchmark::DoNotOptimize(mesh::document::find_shells(million(), request).value());
}
BENCHMARK(shells_of_a_bar_of_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// A field against the opened deck, and how many shells it leaves without a value.
void field_of_a_million(benchmark::State& state, const char* name) {
  const auto wish = mesh::document::field_wish(name).value();
  const Document& document = million();
  for (auto _ : state) {
    const auto field = mesh::document::make_field(wish, document.current(), document, &document.opened->model).value();
    benchmark::DoNotOptimize(shells_without_value(document.current().model, field));
  }
}
BENCHMARK_CAPTURE(field_of_a_million, displacement, "displacement")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(field_of_a_million, distance, "distance-to-original")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(field_of_a_million, warpage, "metric:warpage")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
