// Rewrites the cards that name nodes and shells: sets, segments, and cards that name a single one.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::change_list, for *SET_NODE, *SET_SHELL and so on: plain lists, _COLUMN, _GENERATE and _GENERATE_INCREMENT (new ids become
/// ranges of their own), _GENERAL.
Result<std::vector<Replacement>> change_set(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                            std::span<const std::int64_t> leaving);

/// As CardWriter::segment, replace_segment, inheritance and copy_single.
std::optional<std::array<std::int64_t, 4>> read_segment(std::string_view text, const Referrer& set, std::size_t card);
Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                 std::span<const std::array<std::int64_t, 4>> with);
Inheritance inheritance_of(const Referrer& card, Referred referred);
Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& card, const Reference& single,
                                             std::span<const std::int64_t> ids);

}  // namespace prismesh::mesh::deck::lsdyna
