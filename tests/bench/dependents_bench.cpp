// Measures what welds on a sheet of a million shells cost: at opening, at the beginning of a drag, and with each edit.
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "mesh/deck/open.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/document.h"
#include "mesh/document/drag.h"
#include "mesh/document/find_dependents.h"
#include "mesh/document/generation.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/expression.h"
#include "tests/bench/million_document.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::document {
namespace {

constexpr std::size_t kSide = 1000;

/// The middles of every 100th shell, and of every tenth of the patch in the middle: 11,000 welds, 1,100 of them on the patch.
std::vector<std::size_t> welded_shells() {
  std::vector<std::size_t> shells;
  for (std::size_t s = 0; s < kSide * kSide; ++s) {
    const std::size_t i = s % kSide, j = s / kSide;
    const bool in_patch = i >= 450 && i < 550 && j >= 450 && j < 550;
    if (i % 100 == j % 100 || (in_patch && (i + j) % 10 == 0)) shells.push_back(s);
  }
  return shells;
}

/// The document of a million quads with beams that lie on it, each with its far end above the sheet.
Document& welded_million() {
  static Document document = [] {
    deck::OpenedDeck opened;
    const Document plain = bench::open_million();
    opened.deck = plain.deck;
    opened.model = plain.current().model;
    Model& model = opened.model;
    ElementBlock beams;
    std::size_t next = model.node_count();
    const std::vector<std::size_t> shells = welded_shells();
    model.positions.resize(next + 2 * shells.size(), Vec3::Zero());
    model.node_ids.resize(next + 2 * shells.size());
    model.node_holds.resize(next + 2 * shells.size());
    for (const std::size_t shell : shells) {
      Vec3 middle = Vec3::Zero();
      for (const NodeIndex node : model.shell(ShellIndex(shell)).node) middle += 0.25 * model.position(node);
      for (const double above : {0.2, 20.0}) {
        model.positions.set(next, middle + Vec3(0, 0, above));
        model.node_ids.set(next, static_cast<std::int64_t>(100'000'000 + next));
        beams.nodes.emplace_back(next++);
      }
      beams.id.push_back(static_cast<std::int64_t>(shell + 1));
      beams.part.emplace_back(std::size_t{0});
      beams.first_node.push_back(static_cast<std::uint32_t>(beams.nodes.size()));
    }
    model.elements[static_cast<std::size_t>(ElementClass::beam)] = std::make_shared<const ElementBlock>(std::move(beams));
    std::vector<std::int64_t> ids(model.node_count());
    for (std::size_t n = 0; n < ids.size(); ++n) ids[n] = model.node_ids[n];
    model.node_index = std::make_shared<const IdIndex>(ids);
    model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
    Document made = open("million.k", std::move(opened), {}).value();
    (void)document::apply(made, Edit(Select{bench::patch_expression()})).value();
    return made;
  }();
  return document;
}

void find_welds_at_opening(benchmark::State& state) {
  const Document& document = welded_million();
  std::size_t found = 0;
  for (auto _ : state) {
    const Dependents dependents = find_dependents(*document.deck, document.opened->model, document.current().relations->element_uses);
    found = dependents.on_sheets.size();
  }
  state.counters["rests"] = static_cast<double>(found);
}
BENCHMARK(find_welds_at_opening)->Unit(benchmark::kMillisecond);

void drag_begin_10k_with_welds(benchmark::State& state) {
  const Document& document = welded_million();
  Translate pull;
  std::size_t nodes = 0;
  for (auto _ : state) {
    Result<Drag> drag = Drag::begin(document.generations[document.cursor], Edit(pull));
    if (!drag) return state.SkipWithError(drag.error().text().c_str());
    nodes = drag->nodes().size();
  }
  state.counters["nodes"] = static_cast<double>(nodes);
}
BENCHMARK(drag_begin_10k_with_welds)->Unit(benchmark::kMillisecond);

void translate_10k_with_welds(benchmark::State& state) {
  const Document& document = welded_million();
  Translate pull;
  pull.by = Vec3(0, 0, 1.5);
  for (auto _ : state) {
    const Result<Prepared> prepared = prepare(document, Edit(pull));
    if (!prepared) return state.SkipWithError(prepared.error().text().c_str());
  }
}
BENCHMARK(translate_10k_with_welds)->Unit(benchmark::kMillisecond);

void algebra_on_a_million(benchmark::State& state) {
  const Generation& current = welded_million().current();
  for (auto _ : state)
    benchmark::DoNotOptimize(select::evaluate(current.model, "(part:1 & id>5000 | beam:all) & ~1-900000:10", select::EntityKind::node,
                                              current.relations->names));
}
BENCHMARK(algebra_on_a_million)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prismesh::mesh::document
