// The text of cards that name nodes and elements, and the ids in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/deck/editing/model_difference.h"

namespace prismesh::mesh::deck {

/// The whole text of the card's file.
std::string_view text_of(const Deck& deck, const Referrer& card);

/// Converts an id of the model to the one that the card's text gives, and back. They are the same where the offsets of the card's file
/// aren't known.
std::int64_t id_in_text(const ModelDifference& difference, Referred referred, std::int64_t id, const Referrer& card);
std::int64_t id_in_model(const ModelDifference& difference, Referred referred, std::int64_t id, const Referrer& card);

/// Whether the card's text may be changed. `offset`: of the line that would change; `why`: "it would have to ...", for the message. Errors:
/// its file is included twice, or the offsets of its ids aren't known.
Result<void> check_changeable(const ModelDifference& difference, const Referrer& card, std::uint64_t offset, const std::string& why);

}  // namespace prismesh::mesh::deck
