#include "mesh/deck/assembly/assemble_shells.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "mesh/deck/assembly/gather.h"
#include "mesh/deck/assembly/undefined_node.h"

namespace prismesh::mesh::deck {
namespace {

const auto kShellIds = [](const PieceCards& cards) -> const std::vector<std::int64_t>& { return cards.shells.id; };

std::vector<std::size_t> shell_starts(std::span<const PieceCards> cards) {
  return starts_of(cards, [](const PieceCards& piece) { return piece.shells.id.size(); });
}

/// The corners of each piece's shells, by index. Invalid: nobody defines the node.
std::vector<std::vector<ShellNodes>> find_corners(std::span<const PieceCards> cards, const IdLookup& lookup) {
  std::vector<std::vector<ShellNodes>> corners(cards.size());
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const RawShells& shells = cards[p].shells;
      corners[p].resize(shells.id.size());
      for (std::size_t i = 0; i < shells.id.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) corners[p][i].node[c] = lookup.node(shells.nodes[i][c]);
    }
  });
  return corners;
}

void keep_shells(RawShells& shells, std::vector<ShellNodes>& corners, const std::vector<std::uint8_t>& keep) {
  if (!shells.thickness.empty()) shells.thickness.resize(keep.size());
  const std::vector<std::uint32_t> after = indices_after(keep);
  for (PieceRun& run : shells.runs) run.first = after[run.first];
  std::erase_if(shells.midside, [&](const auto& entry) { return !keep[entry.first]; });
  for (auto& entry : shells.midside) entry.first = after[entry.first];
  keep_only(shells.thickness, keep);
  keep_only(shells.part, keep);
  keep_only(shells.nodes, keep);
  keep_only(shells.offset, keep);
  keep_only(corners, keep);
  keep_only(shells.id, keep);
}

void count_left_out(const RawShells& shells, const std::vector<std::uint8_t>& keep, ElementCounts& counts) {
  std::vector<std::uint8_t> has_midside(keep.size());
  for (const auto& [shell, nodes] : shells.midside) has_midside[shell] = 1;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (!keep[i]) ++counts.of_shell(shells.nodes[i][2] == shells.nodes[i][3], has_midside[i] != 0);
}

/// For each shell of a piece whether all its nodes are defined; empty: all are. Warns of the others and notes their undefined nodes.
std::vector<std::uint8_t> shells_with_nodes(const PieceCards& cards, const std::vector<ShellNodes>& corners, const IdLookup& lookup,
                                            LeftOutElements& left_out, Warnings& warnings) {
  const RawShells& shells = cards.shells;
  std::vector<std::uint8_t> keep;
  const auto drop = [&](std::size_t i, std::int64_t node) {
    if (keep.empty()) keep.assign(shells.id.size(), 1);
    left_out.undefined_nodes.push_back(node);
    if (!keep[i]) return;
    keep[i] = 0;
    note_undefined_node(warnings, {"shell", shells.id[i], node, cards.file, shells.offset[i]});
  };
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      if (!corners[i].node[c].valid()) drop(i, shells.nodes[i][c]);
  for (const auto& [shell, nodes] : shells.midside)
    for (const std::int64_t node : nodes)
      if (node > 0 && !lookup.node(node).valid()) drop(shell, node);
  return keep;
}

void hide_shells(const PieceCards& cards, const std::vector<ShellNodes>& corners, const std::vector<std::uint8_t>& keep,
                 const IdLookup& lookup, LeftOutElements& left_out) {
  const RawShells& shells = cards.shells;
  std::vector<NodeIndex> nodes;
  auto midside = shells.midside.begin();
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) continue;
    nodes.assign(corners[i].node.begin(), corners[i].node.end());
    while (midside != shells.midside.end() && midside->first < i) ++midside;
    if (midside != shells.midside.end() && midside->first == i)
      for (const std::int64_t node : midside->second) nodes.push_back(lookup.node(node));
    hide({ElementClass::shell, shells.id[i], cards.file, shells.offset[i]}, nodes, left_out.hidden);
  }
}

void drop_undefined_shells(PieceCards& cards, std::vector<ShellNodes>& corners, const IdLookup& lookup, LeftOutElements& left_out,
                           Warnings& warnings) {
  RawShells& shells = cards.shells;
  const std::vector<std::uint8_t> keep = shells_with_nodes(cards, corners, lookup, left_out, warnings);
  if (keep.empty()) return;
  count_left_out(shells, keep, left_out.counts);
  hide_shells(cards, corners, keep, lookup, left_out);
  const auto leave_node = [&](NodeIndex node) {
    if (node.valid()) left_out.nodes.push_back(node);
  };
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) continue;
    left_out.ids.push_back(shells.id[i]);
    for (const NodeIndex node : corners[i].node) leave_node(node);
  }
  for (const auto& [shell, nodes] : shells.midside)
    if (!keep[shell])
      for (const std::int64_t node : nodes) leave_node(lookup.node(node));
  keep_shells(shells, corners, keep);
}

/// Shells whose ids other shells have too, by numbering: which of them count.
class SharedIds {
 public:
  explicit SharedIds(const IdIndex& index) : index_(index) {}
  /// True for the first shell of a numbering that has the id. `at`: of the shell among all. To be asked in the deck's order.
  bool counts(std::int64_t id, std::uint8_t numbering, std::size_t at) {
    if (index_.find(id) == at) {
      if (is_shared(id)) taken_.emplace(id, numbering);
      return true;
    }
    return taken_.emplace(id, numbering).second;
  }

 private:
  bool is_shared(std::int64_t id) const { return std::binary_search(index_.duplicates().begin(), index_.duplicates().end(), id); }

  const IdIndex& index_;
  std::set<std::pair<std::int64_t, std::uint8_t>> taken_;
};

void drop_duplicate_shells(PieceCards& cards, SharedIds& shared, std::size_t start, const IdLookup& lookup,
                           std::vector<ShellNodes>& corners, LeftOutElements& left_out, Warnings& warnings) {
  RawShells& shells = cards.shells;
  std::vector<std::uint8_t> keep(shells.id.size());
  auto run = shells.runs.begin();
  for (std::size_t i = 0; i < keep.size(); ++i) {
    while (run != shells.runs.end() && std::next(run) != shells.runs.end() && std::next(run)->first <= i) ++run;
    keep[i] = shared.counts(shells.id[i], run == shells.runs.end() ? std::uint8_t{0} : run->numbering, start + i);
    if (!keep[i])
      warnings.note("duplicate-element", cards.file, shells.offset[i],
                    "shell " + std::to_string(shells.id[i]) + " is defined again; its first definition counts");
  }
  hide_shells(cards, corners, keep, lookup, left_out);
  count_left_out(shells, keep, left_out.counts);
  keep_shells(shells, corners, keep);
}

/// The shells whose id an earlier shell has, ascending by id; null: none.
std::shared_ptr<const std::vector<ShellIndex>> second_shells(const IdIndex& index, const ChunkedArray<std::int64_t>& ids) {
  if (index.duplicates().empty()) return nullptr;
  auto second = std::make_shared<std::vector<ShellIndex>>();
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (index.find(ids[i]) != i) second->push_back(ShellIndex(i));
  std::stable_sort(second->begin(), second->end(), [&](ShellIndex a, ShellIndex b) { return ids[a.value] < ids[b.value]; });
  return second;
}

ChunkedArray<float> gather_thickness(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards) {
  const bool any = std::any_of(cards.begin(), cards.end(), [](const PieceCards& piece) { return !piece.shells.thickness.empty(); });
  if (!any) return ChunkedArray<float>::filled(starts.back());
  return gather<float>(starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<float> out) {
    const std::vector<float>& from = cards[piece].shells.thickness;
    for (std::size_t i = 0; i < count; ++i) out[i] = first + i < from.size() ? from[first + i] : 0;
  });
}

std::vector<MidsideNodes> gather_midside(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards,
                                         const IdLookup& lookup) {
  std::vector<MidsideNodes> midside;
  for (std::size_t p = 0; p < cards.size(); ++p)
    for (const auto& [shell, nodes] : cards[p].shells.midside) {
      MidsideNodes entry{ShellIndex(starts[p] + shell), {}};
      const std::array<std::int64_t, 4>& corners = cards[p].shells.nodes[shell];
      for (std::size_t i = 0; i < 4; ++i)
        // A triangle's third edge has no length; the node given there is a corner again.
        if (nodes[i] > 0 && !(corners[2] == corners[3] && nodes[i] == corners[2])) entry.node[i] = lookup.node(nodes[i]);
      midside.push_back(entry);
    }
  return midside;
}

}  // namespace

AssembledShells assemble_shells(std::span<PieceCards> cards, const IdLookup& lookup, LeftOutElements& left_out, Warnings& warnings) {
  std::vector<std::vector<ShellNodes>> corners = find_corners(cards, lookup);
  for (std::size_t p = 0; p < cards.size(); ++p) drop_undefined_shells(cards[p], corners[p], lookup, left_out, warnings);
  AssembledShells shells;
  std::vector<std::size_t> starts = shell_starts(cards);
  shells.index = index_of(starts, cards, kShellIds);
  if (!shells.index->duplicates().empty()) {
    SharedIds shared(*shells.index);
    for (std::size_t p = 0; p < cards.size(); ++p)
      drop_duplicate_shells(cards[p], shared, starts[p], lookup, corners[p], left_out, warnings);
    starts = shell_starts(cards);
    shells.index = index_of(starts, cards, kShellIds);
  }
  shells.ids = gather_field<std::int64_t>(starts, cards, kShellIds);
  shells.second = second_shells(*shells.index, shells.ids);
  shells.nodes = gather<ShellNodes>(starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<ShellNodes> out) {
    std::copy_n(corners[piece].begin() + static_cast<std::ptrdiff_t>(first), count, out.begin());
  });
  shells.parts = gather<PartIndex>(starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<PartIndex> out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = lookup.part(cards[piece].shells.part[first + i]);
  });
  shells.thickness = gather_thickness(starts, cards);
  shells.midside = std::make_shared<const std::vector<MidsideNodes>>(gather_midside(starts, cards, lookup));
  shells.offset = concatenate<std::uint64_t>(
      starts, cards, [](const PieceCards& piece) -> const std::vector<std::uint64_t>& { return piece.shells.offset; });
  shells.runs = join_runs(starts, cards, [](const PieceCards& piece) -> const std::vector<PieceRun>& { return piece.shells.runs; });
  free_each(cards, [](PieceCards& piece) { piece.shells = {}; });
  return shells;
}

}  // namespace prismesh::mesh::deck
