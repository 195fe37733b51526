#include "mesh/deck/nastran/reader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/nastran/piece.h"
#include "mesh/deck/nastran/settle.h"
#include "mesh/deck/nastran/walk.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// Refuses elements of the 1970s: their format is documented, but nobody could check a model with them.
std::optional<Error> refuse_old_elements(const DeckContents& found, std::span<const PieceFacts> facts) {
  std::string name;
  std::size_t count = 0, first = 0, kinds = 0;
  std::uint32_t file = 0;
  std::map<std::string_view, std::size_t> all;
  for (std::size_t p = 0; p < facts.size(); ++p)
    for (const auto& [old, entry] : facts[p].old_elements) {
      if (name.empty() || (file == found.cards[p].file && entry.first < first && all.empty())) {
        name = old;
        first = entry.first;
        file = found.cards[p].file;
      }
      all[old] += entry.second;
    }
  if (name.empty()) return std::nullopt;
  count = all[name];
  kinds = all.size();
  return Error{found.files[file].path.string(), line_number(found.files[file].bytes.text(), first),
               name + " is an element of the 1970s that this version doesn't read (" + std::to_string(count) + " of them" +
                   (kinds > 1 ? ", and " + std::to_string(kinds - 1) + " other such kinds" : "") +
                   "); convert the deck to CQUAD4 and CTRIA3 first"};
}

/// Whether a line is an entry of bulk data: a sentence may begin with "Include". A deck of nothing but INCLUDE statements is one, too.
bool has_bulk_data(std::span<const PieceFacts> facts, bool has_other_sections) {
  const bool has_cards = std::any_of(facts.begin(), facts.end(), [](const PieceFacts& some) { return some.has_cards; });
  const bool has_known_cards = std::any_of(facts.begin(), facts.end(), [](const PieceFacts& some) { return some.has_known_cards; });
  return has_known_cards || (!has_cards && !has_other_sections);
}

void settle_parts(DeckContents& found, std::span<PieceFacts> facts, PartTable& table) {
  for (std::size_t p = 0; p < facts.size(); ++p) {
    for (const Property& property : facts[p].definitions.properties)
      if (table.add(property))
        found.warnings.note("duplicate-property", found.cards[p].file, property.offset,
                            "property " + std::to_string(property.id) + " is defined again; its first definition counts");
    for (const Material& material : facts[p].definitions.materials) table.add(material);
    for (const auto& [id, name] : facts[p].definitions.names) table.add_name(id, name);
  }
  found.parts = table.parts();
}

void settle_notices(DeckContents& found, std::span<PieceFacts> facts) {
  for (std::size_t p = 0; p < facts.size(); ++p)
    for (Notice& notice : facts[p].notices)
      found.warnings.note(notice.kind, found.cards[p].file, notice.offset, std::move(notice.message), notice.count);
}

}  // namespace

Result<DeckContents> read(FileSet files, Watch& watch) {
  Walk walk(std::move(files));
  walk.run();
  watch.tell(kWalked);
  DeckContents found;
  found.format = Format::nastran;
  found.files = std::move(walk.files.files);
  found.missing_files = std::move(walk.files.missing);
  found.companions = std::move(walk.files.companions);
  found.unread_files = std::move(walk.files.unread);
  found.warnings = std::move(walk.warnings);
  std::vector<PieceFacts> facts(walk.pieces.size());
  const auto read_one = [&](std::size_t p) {
    const Piece& piece = walk.pieces[p];
    PieceContent content = read_piece(found.files[piece.file].bytes.text(), piece);
    content.cards.held = walk.held[piece.file];
    facts[p] = std::move(content.facts);
    return std::move(content.cards);
  };
  read_pieces(found, walk.pieces.size(), read_one, watch);
  if (watch.stopped()) return fail(cancelled());
  if (!walk.has_statements && !has_bulk_data(facts, walk.has_other_sections))
    return fail(found.files[0].path.string(), "is no deck: it looks like text without a single card of a deck");
  if (std::optional<Error> error = refuse_old_elements(found, facts)) return fail(std::move(*error));

  settle_notices(found, facts);
  settle_frames(found, facts);
  found.references = walk.references.finish();
  settle_scalar_points(found, facts);
  settle_taken_ids(found, facts);
  PartTable table;
  settle_parts(found, facts, table);
  settle_thickness(found, facts, table);
  note_shared_element_ids(found);
  for (PieceFacts& some : facts) found.references.append(std::move(some.references));
  facts.clear();
  return found;
}

}  // namespace prismesh::mesh::deck::nastran
