#include "mesh/deck/lsdyna/reader.h"

#include <optional>
#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/lsdyna/include_frames.h"
#include "mesh/deck/lsdyna/walk.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// Reads the deck with one walk. nullopt: an encrypted part stands in the mesh, so the walk must search for them.
std::optional<DeckContents> read_once(Walk& walk, Watch& watch) {
  walk.run();
  watch.tell(kWalked);
  DeckContents found;
  found.format = Format::ls_dyna;
  found.files = std::move(walk.files.files);
  const auto read = [&](std::size_t p) {
    return read_piece(found.files[walk.pieces[p].file].bytes.text(), walk.pieces[p], walk.parameter_tables, walk.contexts);
  };
  read_pieces(found, walk.pieces.size(), read, watch);
  for (const PieceCards& cards : found.cards)
    if (cards.encrypted) {
      walk.files.files = std::move(found.files);
      return std::nullopt;
    }
  if (walk.contexts.size() > 1) {
    found.frames = include_frames(walk.contexts, walk.transformations, found.cards, walk.warnings);
    for (const IncludeContext& context : walk.contexts) found.id_offsets.push_back(context.offsets);
  }
  found.taken = walk.generated.finish(largest_ids(found.cards));
  found.references = walk.references.finish(found.files);
  found.missing_files = std::move(walk.files.missing);
  found.companions = std::move(walk.files.companions);
  found.unread_files = std::move(walk.files.unread);
  found.time_step = walk.definitions.time_step();
  found.contacts = walk.definitions.contacts();
  found.parts = walk.definitions.parts();
  found.warnings = std::move(walk.warnings);
  return found;
}

}  // namespace

Result<DeckContents> read(FileSet files, Watch& watch) {
  const std::filesystem::path path = files.files[0].path;
  Walk walk(std::move(files), false);
  std::optional<DeckContents> opened = read_once(walk, watch);
  if (opened) return std::move(*opened);
  Walk careful(FileSet::again(std::move(walk.files)), true);
  opened = read_once(careful, watch);
  if (opened) return std::move(*opened);
  return fail(path.string(), "has an encrypted block that begins but doesn't end");
}

}  // namespace prismesh::mesh::deck::lsdyna
