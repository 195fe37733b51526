#include "mesh/deck/radioss/reader.h"

#include <utility>

#include "mesh/deck/opening.h"
#include "mesh/deck/radioss/assembly.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr double kWalked = 0.2;  ///< how far the walk brings the progress: about its share of the time

}  // namespace

Result<OpenedDeck> read(FileSet files, const Progress& progress) {
  Watch watch(progress);
  Walk walk(std::move(files));
  walk.run();
  watch.tell(kWalked);
  Collected collected(walk);
  if (Result<void> sorted = collected.sort_blocks(); !sorted) return fail(sorted.error());
  Found found;
  found.format = Format::radioss;
  found.files = std::move(walk.files.files);
  std::vector<std::vector<Direction>> directions(collected.pieces.size());
  const MeshContext context{walk.contexts, &collected.parameters};
  const auto read_one = [&](std::size_t p) {
    return read_piece(found.files[collected.pieces[p].file].bytes.text(), collected.pieces[p], context, directions[p]);
  };
  read_pieces(found, collected.pieces.size(), read_one, watch);
  found.missing_files = std::move(walk.files.missing);
  found.warnings = std::move(walk.warnings);
  if (!watch.stopped()) collected.complete(found, directions);
  return finish(std::move(found), watch);
}

}  // namespace prismesh::mesh::deck::radioss
