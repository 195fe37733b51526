#include "mesh/deck/editing/referrer_text.h"

#include <optional>

#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

/// What the model's ids are more than those that the card gives; nullopt: as Deck::offsets_in.
std::optional<IdOffsets> id_offsets_of(const ModelDifference& difference, const Referrer& card) {
  return difference.writer.shifts_whole_files() ? difference.deck.offsets_in(card.file) : IdOffsets();
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
