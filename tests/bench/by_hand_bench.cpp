// Measures operations by hand in a deck of a million shells: their cost follows what has changed in the structure, however many nodes moved
// before.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "mesh/deck/sample.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"

namespace prismesh::mesh::document {
namespace {

/// The sample; if asked for, with all its nodes moved.
Document million(bool moved) {
  std::string folder = (std::filesystem::temp_directory_path() / "prismesh-by-hand-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) std::abort();
  const std::filesystem::path deck = std::filesystem::path(folder) / "sample.k";
  if (!deck::write_sample(deck, 1'000'000)) std::abort();
  Document document = open(deck, OpenOptions{}).value();
  std::filesystem::remove_all(folder);
  if (moved)
    (void)mesh::document::apply(document,
                                parse_edit(R"({"edit":"translate","by":[1,0,0.3],"on":"all","falloff":{"profile":"constant"}})").value())
        .value();
  return document;
}

void split_by_hand(benchmark::State& state) {
  const Document document = million(state.range(0) != 0);
  const std::string id = std::to_string(document.current().model.shell_ids[document.current().model.shell_count() / 2]);
  const Edit edit = parse_edit(R"({"edit":"split","at":["shell:)" + id + "\"]}").value();
  for (auto _ : state) benchmark::DoNotOptimize(prepare(document, edit).value());
}
BENCHMARK(split_by_hand)->ArgName("moved")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->Iterations(3)->MeasureProcessCPUTime();

}  // namespace
}  // namespace prismesh::mesh::document
