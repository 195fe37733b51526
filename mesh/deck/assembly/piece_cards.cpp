#include "mesh/deck/assembly/piece_cards.h"

#include <algorithm>

namespace prismesh::mesh::deck {
namespace {

/// A run goes on where nothing changes; an empty one gives way to the next.
void begin_run(std::vector<PieceRun>& runs, PieceRun run) {
  if (!runs.empty() && runs.back().first == run.first) runs.pop_back();
  if (!runs.empty() && runs.back().style == run.style && runs.back().frame == run.frame && runs.back().numbering == run.numbering) return;
  runs.push_back(run);
}

}  // namespace

void PieceCards::begin_nodes(std::uint16_t style, std::uint32_t frame) {
  begin_run(node_runs, {static_cast<std::uint32_t>(node_id.size()), style, frame, 0});
}

void PieceCards::begin_shells(std::uint16_t style, std::uint32_t frame, std::uint8_t numbering) {
  begin_run(shells.runs, {static_cast<std::uint32_t>(shells.id.size()), style, frame, numbering});
}

void PieceCards::hide(ElementClass element_class, std::size_t offset, std::int64_t id, std::span<const std::int64_t> nodes) {
  hidden.push_back({element_class, id, offset, {nodes.begin(), nodes.end()}});
}

void PieceCards::note(std::string_view kind, std::size_t offset, std::int64_t id) {
  const auto at = std::find_if(oddities.begin(), oddities.end(), [&](const Oddity& o) { return o.kind == kind; });
  if (at != oddities.end())
    ++at->count;
  else
    oddities.push_back({std::string(kind), offset, id, 1});
}

void PieceCards::count_kind(std::string_view kind, std::size_t count) {
  // Cards of a kind mostly follow each other.
  const auto at = std::find_if(kinds.rbegin(), kinds.rend(), [&](const auto& entry) { return entry.first == kind; });
  if (at != kinds.rend())
    at->second += count;
  else
    kinds.emplace_back(kind, count);
}

}  // namespace prismesh::mesh::deck
