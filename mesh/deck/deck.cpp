#include "mesh/deck/deck.h"

#include <algorithm>

#include "mesh/deck/detect.h"
#include "mesh/deck/lsdyna/reader.h"

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

std::uint32_t Deck::run_of(NodeIndex node) const {
  const auto after = std::upper_bound(node_runs.begin(), node_runs.end(), node.value,
                                      [](std::uint32_t value, const NodeRun& run) { return value < run.first_node; });
  return static_cast<std::uint32_t>(after - node_runs.begin()) - 1;
}

Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress) {
  if (progress && !progress(0)) return fail(cancelled());
  Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const Detected detected = detect_format(bytes->text());
  if (!detected.format) return fail(path.string(), "is no deck: it looks like " + detected.looks_like);
  if (*detected.format == Format::ls_dyna) return lsdyna::read(path, std::move(*bytes), progress);
  const std::string_view what = *detected.format == Format::nastran   ? "a Nastran"
                                : *detected.format == Format::radioss ? "a Radioss"
                                                                      : "an Abaqus";
  return fail(path.string(), "looks like " + std::string(what) + " deck; this version reads LS-DYNA");
}

}  // namespace prismesh::mesh::deck
