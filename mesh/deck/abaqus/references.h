// Finds the keywords that name nodes and elements, for the reverse index.
#pragma once

#include "mesh/deck/abaqus/outline.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::abaqus {

/// Referrer::style: bits.
inline constexpr std::uint16_t kStyleGenerate = 1;     ///< a set of ranges
inline constexpr std::uint16_t kStyleOtherIds = 2;     ///< the ids on its lines aren't the model's, or are those of several instances
inline constexpr std::uint16_t kStyleNamesAndIds = 4;  ///< not a set: lines have more than ids

/// All cards that name entities, by the model's ids: Instance::shift must be set. Unknown keywords are unread text.
References find_references(const DeckOutline& outline);

}  // namespace prismesh::mesh::deck::abaqus
