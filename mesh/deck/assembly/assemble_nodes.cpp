#include "mesh/deck/assembly/assemble_nodes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/deck/assembly/gather.h"

namespace prismesh::mesh::deck {
namespace {

const auto kNodeIds = [](const PieceCards& cards) -> const std::vector<std::int64_t>& { return cards.node_id; };

std::vector<std::size_t> node_starts(std::span<const PieceCards> cards) {
  return starts_of(cards, [](const PieceCards& piece) { return piece.node_id.size(); });
}

void keep_nodes(PieceCards& cards, const std::vector<std::uint8_t>& keep) {
  const std::vector<std::uint32_t> after = indices_after(keep);
  for (PieceRun& run : cards.node_runs) run.first = after[run.first];
  std::erase_if(cards.by_parameter, [&](std::uint32_t node) { return !keep[node]; });
  for (std::uint32_t& node : cards.by_parameter) node = after[node];
  std::erase_if(cards.holds, [&](const auto& hold) { return !keep[hold.first]; });
  for (auto& hold : cards.holds) hold.first = after[hold.first];
  keep_only(cards.position, keep);
  keep_only(cards.node_offset, keep);
  keep_only(cards.node_id, keep);
}

void drop_duplicate_nodes(std::span<PieceCards> cards, const IdIndex& index, const std::vector<std::size_t>& starts, Warnings& warnings) {
  for (std::size_t p = 0; p < cards.size(); ++p) {
    PieceCards& piece = cards[p];
    std::vector<std::uint8_t> keep(piece.node_id.size());
    for (std::size_t i = 0; i < keep.size(); ++i) {
      keep[i] = index.find(piece.node_id[i]) == starts[p] + i;
      if (keep[i] && std::binary_search(index.duplicates().begin(), index.duplicates().end(), piece.node_id[i]))
        piece.holds.emplace_back(static_cast<std::uint32_t>(i), kHeldByRepeat);
      if (!keep[i])
        warnings.note("duplicate-node", piece.file, piece.node_offset[i],
                      "node " + std::to_string(piece.node_id[i]) + " is defined again; its first definition counts");
    }
    keep_nodes(piece, keep);
  }
}

ChunkedArray<std::uint8_t> gather_holds(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards) {
  auto holds = ChunkedArray<std::uint8_t>::filled(starts.back());
  const auto add = [&](std::size_t node, std::uint8_t why) { holds.set(node, static_cast<std::uint8_t>(holds[node] | why)); };
  for (std::size_t p = 0; p < cards.size(); ++p) {
    const PieceCards& piece = cards[p];
    if (piece.held)
      for (std::size_t i = 0; i < piece.node_id.size(); ++i) holds.set(starts[p] + i, kHeldByInclude);
    for (const std::uint32_t node : piece.by_parameter) add(starts[p] + node, kHeldByParameter);
    for (const auto& [node, why] : piece.holds) add(starts[p] + node, why);
  }
  return holds;
}

void to_basic_system(ChunkedArray<Vec3>& positions, std::span<const CardRun> runs, std::span<const Frame> frames) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Frame& frame = frames[runs[r].frame];
    if (frame.is_basic()) continue;
    const std::size_t end = r + 1 < runs.size() ? runs[r + 1].first : positions.size();
    for (std::size_t n = runs[r].first; n < end; ++n) positions.set(n, to_basic(frame, positions[n]));
  }
}

}  // namespace

AssembledNodes assemble_nodes(std::span<PieceCards> cards, std::span<const Frame> frames, Warnings& warnings) {
  AssembledNodes nodes;
  std::vector<std::size_t> starts = node_starts(cards);
  nodes.index = index_of(starts, cards, kNodeIds);
  if (!nodes.index->duplicates().empty()) {
    drop_duplicate_nodes(cards, *nodes.index, starts, warnings);
    starts = node_starts(cards);
    nodes.index = index_of(starts, cards, kNodeIds);
  }
  nodes.ids = gather_field<std::int64_t>(starts, cards, kNodeIds);
  nodes.positions = gather_field<Vec3>(starts, cards, [](const PieceCards& piece) -> const std::vector<Vec3>& { return piece.position; });
  nodes.offset = concatenate<std::uint64_t>(starts, cards,
                                            [](const PieceCards& piece) -> const std::vector<std::uint64_t>& { return piece.node_offset; });
  nodes.runs = join_runs(starts, cards, [](const PieceCards& piece) -> const std::vector<PieceRun>& { return piece.node_runs; });
  nodes.holds = gather_holds(starts, cards);
  free_each(cards, [](PieceCards& piece) {
    piece.node_id = {};
    piece.position = {};
    piece.node_offset = {};
  });
  to_basic_system(nodes.positions, nodes.runs, frames);
  return nodes;
}

}  // namespace prismesh::mesh::deck
