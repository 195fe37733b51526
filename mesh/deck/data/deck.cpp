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

namespace {

const CardRun& run_of(const std::vector<CardRun>& runs, std::uint32_t index) {
  return *std::prev(
      std::upper_bound(runs.begin(), runs.end(), index, [](std::uint32_t value, const CardRun& run) { return value < run.first; }));
}

}  // namespace

const CardRun& Deck::run_of(NodeIndex node) const { return deck::run_of(node_runs, node.value); }
const CardRun& Deck::run_of(ShellIndex shell) const { return deck::run_of(shell_runs, shell.value); }

}  // namespace prismesh::mesh::deck
