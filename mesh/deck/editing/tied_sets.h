// Which sets the cards use that tie nodes to sheets: *CONTACT_TIED..., *CONTACT_SPOTWELD..., /INTER/TYPE2.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// The cards of sets of nodes that list the node and that a tie uses, itself or by a set of sets; each set once. `node`: id.
std::vector<std::uint32_t> tied_sets_of(const References& references, std::int64_t node);

/// The parts that the cards name, themselves or by sets of parts, that tie the nodes of a part; ascending, the part itself too. Empty: no
/// such card, or one names something else than parts (segments, nodes, everything), so that it can't be told.
std::vector<std::int64_t> parts_tied_with(const References& references, std::int64_t part);

}  // namespace prismesh::mesh::deck
