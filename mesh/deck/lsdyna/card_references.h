// Reads what cards name by the table of reference_tables.h. Private to references.
#pragma once

#include <string_view>

#include "mesh/deck/lsdyna/block_lines.h"
#include "mesh/deck/lsdyna/reference_collector.h"
#include "mesh/deck/lsdyna/reference_tables.h"

namespace prismesh::mesh::deck::lsdyna {

/// Reads the cards of a rule. False: the rule doesn't know an option.
bool read_card_references(BlockLines& lines, const ReferenceRule& rule, std::string_view options, ReferenceCollector& out);

/// *CONTACT: reads its surfaces. In front of them stand a title, then one line of _MPP or two, the second of which begins with '&'.
/// False: it is one of those contacts whose cards aren't known.
bool read_contact_references(BlockLines& lines, ReferenceCollector& out);

}  // namespace prismesh::mesh::deck::lsdyna
