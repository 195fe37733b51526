// Writes the cards of shells: *ELEMENT_SHELL with its options.
#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::shell_end; includes the cards of the options.
std::size_t shell_end(const CardRef& card);

/// As CardWriter::shell. Corner thicknesses that differ are mixed by ShellCard::share. Angles (_BETA, those of layers) change against the
/// turn of the first edge. Coordinate systems, offsets and layers stay. Comments between the cards stay with the shell of the same id.
Result<WrittenCard> write_shell(const CardRef& card, const ShellCard& shell);

}  // namespace prismesh::mesh::deck::lsdyna
