#include "mesh/deck/radioss/reader.h"

#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/radioss/assembly.h"

namespace prismesh::mesh::deck::radioss {
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
  found.warnings = std::move(walk.warnings);
  if (!watch.stopped()) collected.complete(found, directions);
  return found;
}

}  // namespace prismesh::mesh::deck::radioss
