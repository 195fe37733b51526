#include "mesh/deck/radioss/reader.h"

#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/radioss/assembly.h"

namespace prismesh::mesh::deck::radioss {
namespace {

/// Adaptive meshing numbers what it adds from here on, reserves of particles from 1,000,000,000.
/// Source: OpenRadioss, "element_user_id.F90" and "build_admesh.F"; Radioss Reference Guide, "/ADMESH/GLOBAL".
constexpr IdRange kIdsOfTheSolver{899'999'999, std::int64_t{1} << 60};

TakenIds ids_of_the_solver(const Walk& walk, std::span<const SourceFile> files) {
  for (const Block& block : walk.blocks) {
    const Keyword keyword = keyword_at(files[block.file].bytes.text(), block.offset);
    const std::string_view word = keyword.word(0);
    if (word == "ADMESH" || word == "IGE3D" || (word == "SPH" && keyword.word(1) == "RESERVE"))
      return {{kIdsOfTheSolver}, {kIdsOfTheSolver}};
  }
  return {};
}

}  // namespace

Result<DeckContents> read(FileSet files, Watch& watch) {
  Walk walk(std::move(files));
  walk.run();
  watch.tell(kWalked);
  Collected collected(walk);
  if (Result<void> sorted = collected.sort_blocks(); !sorted) return fail(sorted.error());
  DeckContents found;
  found.format = Format::radioss;
  found.files = std::move(walk.files.files);
  std::vector<std::vector<Direction>> directions(collected.pieces.size());
  const MeshContext context{walk.contexts, &collected.parameters};
  const auto read_one = [&](std::size_t p) {
    return read_piece(found.files[collected.pieces[p].file].bytes.text(), collected.pieces[p], context, directions[p]);
  };
  read_pieces(found, collected.pieces.size(), read_one, watch);
  found.missing_files = std::move(walk.files.missing);
  found.companions = std::move(walk.files.companions);
  found.unread_files = std::move(walk.files.unread);
  found.warnings = std::move(walk.warnings);
  found.taken = ids_of_the_solver(walk, found.files);
  if (!watch.stopped()) collected.complete(found, directions);
  return found;
}

}  // namespace prismesh::mesh::deck::radioss
