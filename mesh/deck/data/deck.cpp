#include "mesh/deck/data/deck.h"

#include <algorithm>

namespace prismesh::mesh::deck {

std::string_view name(Format format) {
  switch (format) {
    case Format::nastran: return "nastran";
    case Format::radioss: return "radioss";
    case Format::abaqus: return "abaqus";
    case Format::ls_dyna: break;
  }
  return "ls-dyna";
}

ElementCounts& ElementCounts::operator+=(const ElementCounts& more) {
  quad += more.quad;
  tri += more.tri;
  quad8 += more.quad8;
  tri6 += more.tri6;
  beam += more.beam;
  solid += more.solid;
  tshell += more.tshell;
  other += more.other;
  return *this;
}

std::size_t& ElementCounts::of_shell(bool is_triangle, bool has_midside) {
  return is_triangle ? (has_midside ? tri6 : tri) : (has_midside ? quad8 : quad);
}

std::size_t& ElementCounts::of(ElementClass element_class) {
  switch (element_class) {
    case ElementClass::shell: return quad;
    case ElementClass::beam: return beam;
    case ElementClass::solid: return solid;
    case ElementClass::tshell: return tshell;
    default: return other;
  }
}

ElementCounts ElementCounts::without(const ElementCounts& fewer) const {
  const auto left = [](std::size_t all, std::size_t some) { return all - std::min(all, some); };
  return {left(quad, fewer.quad), left(tri, fewer.tri),     left(quad8, fewer.quad8),   left(tri6, fewer.tri6),
          left(beam, fewer.beam), left(solid, fewer.solid), left(tshell, fewer.tshell), left(other, fewer.other)};
}

namespace {

const CardRun& run_of(const std::vector<CardRun>& runs, std::uint32_t index) {
  return *std::prev(
      std::upper_bound(runs.begin(), runs.end(), index, [](std::uint32_t value, const CardRun& run) { return value < run.first; }));
}

}  // namespace

std::optional<IdOffsets> Deck::offsets_in(std::uint32_t file) const {
  const auto shifted = [](const IdOffsets& offsets) { return !(offsets == IdOffsets()); };
  if (std::none_of(id_offsets.begin(), id_offsets.end(), shifted)) return IdOffsets();
  std::optional<IdOffsets> found;
  for (const auto* runs : {&node_runs, &shell_runs})
    for (const CardRun& run : *runs) {
      if (run.file != file) continue;
      const IdOffsets offsets = offsets_of(run);
      if (found && !(*found == offsets)) return std::nullopt;
      found = offsets;
    }
  // The main file is never shifted.
  if (!found && file == 0) return IdOffsets();
  return found;
}

const CardRun& Deck::run_of(NodeIndex node) const { return deck::run_of(node_runs, node.value); }
const CardRun& Deck::run_of(ShellIndex shell) const { return deck::run_of(shell_runs, shell.value); }

}  // namespace prismesh::mesh::deck
