#include "mesh/document/save.h"

#include <algorithm>

#include "base/counted.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/save.h"
#include "mesh/document/deck_settings.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

namespace {

/// A note on how rounded positions change the quality of their shells; empty if they don't.
std::string rounding_note(const Document& document, const deck::Rounding& rounding) {
  if (rounding.nodes.empty()) return "";
  const Generation& current = document.current();
  Model as_read = current.model;
  NodeSet nodes;
  for (const auto& [node, at] : rounding.nodes) {
    as_read.positions.set(node.value, at);
    nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  ChunkedArray<quality::ShellState> states = current.quality;
  quality::Counts counts = current.counts;
  quality::rejudge(as_read, judged_by(document), shells_touching(as_read, nodes), states, counts);
  if (counts == current.counts) return "";
  const auto said = [](const quality::Counts& c) { return counted(c.warn, "element") + " warn and " + std::to_string(c.fail) + " fail"; };
  return "with the rounded numbers, as the deck is read again, " + said(counts) + "; before, " + said(current.counts);
}

}  // namespace

Result<deck::SaveReport> save(const Document& document, const std::filesystem::path& target, const Progress& progress) {
  Result<deck::StagedSave> staged = stage_save(document, target, progress);
  if (!staged) return fail(std::move(staged.error()));
  if (Result<void> placed = staged->put_in_place_or_leave(); !placed) return fail(std::move(placed.error()));
  deck::SaveReport report = staged->report();
  if (const Result<void> kept = keep_deck_settings(document, target); !kept)
    report.notes.push_back("target sizes and criteria are not kept beside the deck: " + kept.error().text());
  return report;
}

Result<deck::StagedSave> stage_save(const Document& document, const std::filesystem::path& target, const Progress& progress) {
  Result<deck::StagedSave> staged =
      deck::StagedSave::write(*document.deck, document.opened->model, document.current().model, target, progress, document.make_text);
  if (staged)
    if (std::string note = rounding_note(document, staged->rounding()); !note.empty()) staged->add_note(std::move(note));
  return staged;
}

}  // namespace prismesh::mesh::document
