// Writing the cards of shells: *ELEMENT_SHELL with its options.
#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::shell_end: with the cards of the options.
std::size_t shell_end(const CardRef& card);

/// As CardWriter::shell. Corner thicknesses are mixed by share where they differ; angles (_BETA, those of layers) turn against the first
/// edge; coordinate systems, offsets and layers stay. Comments between the cards stay with the shell of the same id.
Result<WrittenCard> write_shell(const CardRef& card, const ShellCard& shell);

}  // namespace prismesh::mesh::deck::lsdyna
