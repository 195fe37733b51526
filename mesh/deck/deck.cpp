#include "mesh/deck/deck.h"

#include <algorithm>

#include "mesh/deck/abaqus/reader.h"
#include "mesh/deck/abaqus/writer.h"
#include "mesh/deck/card_writer.h"
#include "mesh/deck/detect.h"
#include "mesh/deck/file_set.h"
#include "mesh/deck/lsdyna/reader.h"
#include "mesh/deck/lsdyna/writer.h"
#include "mesh/deck/nastran/reader.h"
#include "mesh/deck/nastran/writer.h"
#include "mesh/deck/radioss/reader.h"
#include "mesh/deck/radioss/writer.h"

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

namespace {

/// How far unpacking brings the progress; the walk over the text goes on from there.
constexpr double kUnpacked = 0.1;

}  // namespace

Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress, const StandIns& stand_ins) {
  if (progress && !progress(0)) return fail(cancelled());
  const Progress unpacking = [&](double fraction) { return !progress || progress(kUnpacked * fraction); };
  Result<FileSet> files = FileSet::begin(path, stand_ins, unpacking);
  if (!files) return fail(std::move(files.error()));
  const Detected detected = detect_format(files->files[0].bytes.text());
  if (!detected.format) return fail(path.string(), "is no deck: it looks like " + detected.looks_like);
  if (*detected.format == Format::ls_dyna) return lsdyna::read(std::move(*files), progress);
  if (*detected.format == Format::radioss) return radioss::read(std::move(*files), progress);
  if (*detected.format == Format::abaqus) return abaqus::read(std::move(*files), progress);
  return nastran::read(std::move(*files), progress);
}

std::unique_ptr<const CardWriter> card_writer(Format format) {
  switch (format) {
    case Format::abaqus: return abaqus::card_writer();
    case Format::radioss: return radioss::card_writer();
    case Format::nastran: return nastran::card_writer();
    case Format::ls_dyna: break;
  }
  return lsdyna::card_writer();
}

}  // namespace prismesh::mesh::deck
