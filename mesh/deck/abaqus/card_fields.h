// The fields of a card in its text, and new text in their places. Private to mesh/deck/abaqus.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::mesh::deck::abaqus {

/// A set's line has at most so many numbers; a full line of an element goes on in the next one.
inline constexpr std::size_t kIdsOnALine = 16;

/// One past the line's last character.
std::size_t end_of_line(std::string_view text, std::size_t offset);

/// A field in a card's text: between its commas, blanks included.
struct FieldRange {
  std::size_t begin = 0;
  std::size_t length = 0;
};

/// The fields of a line that begins at `at`. Blanks behind the last comma are no field.
std::vector<FieldRange> places_of_line(std::string_view line, std::size_t at);

bool starts_with_blanks(std::string_view field);

/// The new text in the old field, with the blanks around it. In a column it ends where the old text did, if it fits.
std::string in_place_of(std::string_view old, const std::string& text, bool column);

/// The first `wanted` fields of the card at `offset`, which may have several lines. `end` gets the end of the line of the last one.
std::vector<FieldRange> cut_card(std::string_view text, std::size_t offset, std::size_t wanted, std::size_t& end);

}  // namespace prismesh::mesh::deck::abaqus
