// Reads what sets hold: *SET_NODE, *SET_SHELL, *SET_SEGMENT, ... Private to references.
#pragma once

#include <string_view>

#include "mesh/deck/lsdyna/block_lines.h"
#include "mesh/deck/lsdyna/reference_collector.h"

namespace prismesh::mesh::deck::lsdyna {

/// `letter`: what the set holds, as ReferenceRule has it ('n', 's', ...; 'g': segments). `options`: what follows "SET_NODE". False: an
/// option, or a line of a general set, isn't understood.
bool read_set_references(BlockLines& lines, char letter, std::string_view options, ReferenceCollector& out);

}  // namespace prismesh::mesh::deck::lsdyna
