#include "mesh/deck/editing/referrer_text.h"

#include <algorithm>
#include <optional>

#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

/// What an include adds to the ids of a file's text; nullopt: it differs from place to place, or the file has no mesh to tell it by.
std::optional<IdOffsets> id_offsets_in(const Deck& deck, std::uint32_t file) {
  const auto shifted = [](const IdOffsets& offsets) { return !(offsets == IdOffsets()); };
  if (std::none_of(deck.id_offsets.begin(), deck.id_offsets.end(), shifted)) return IdOffsets();
  std::optional<IdOffsets> found;
  for (const auto* runs : {&deck.node_runs, &deck.shell_runs})
    for (const CardRun& run : *runs) {
      if (run.file != file) continue;
      const IdOffsets offsets = deck.offsets_of(run);
      if (found && !(*found == offsets)) return std::nullopt;
      found = offsets;
    }
  // The main file is never shifted.
  if (!found && file == 0) return IdOffsets();
  return found;
}

/// What the model's ids are more than those that the card gives; nullopt: as id_offsets_in.
std::optional<IdOffsets> id_offsets_of(const ModelDifference& difference, const Referrer& card) {
  return difference.writer.shifts_whole_files() ? id_offsets_in(difference.deck, card.file) : IdOffsets();
}

std::int64_t offset_of(const ModelDifference& difference, Referred referred, const Referrer& card) {
  const IdOffsets offsets = id_offsets_of(difference, card).value_or(IdOffsets());
  return referred == Referred::node ? offsets.node : offsets.element;
}

}  // namespace

std::string_view text_of(const Deck& deck, const Referrer& card) { return deck.files[card.file].bytes.text(); }

std::int64_t id_in_text(const ModelDifference& difference, Referred referred, std::int64_t id, const Referrer& card) {
  return id - offset_of(difference, referred, card);
}

std::int64_t id_in_model(const ModelDifference& difference, Referred referred, std::int64_t id, const Referrer& card) {
  return id + offset_of(difference, referred, card);
}

Result<void> check_changeable(const ModelDifference& difference, const Referrer& card, std::uint64_t offset, const std::string& why) {
  const Deck& deck = difference.deck;
  const auto refuse = [&](const std::string& place) {
    return fail(refusal_at(deck, card.file, offset, card_name(deck.format, card) + " stands in an include " + place + ", and " + why));
  };
  if (deck.is_held(card.file)) return refuse("that is used twice");
  if (!id_offsets_of(difference, card)) return refuse("without a mesh, so that it isn't known by how much its ids are shifted");
  return {};
}

}  // namespace prismesh::mesh::deck
