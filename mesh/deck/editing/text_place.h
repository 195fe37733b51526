// Names places in the text of a deck's files for messages and errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// "folder/deck.k:12": the path as opened, and the line at the byte `offset`. `file`: index into Deck::files.
std::string place_of(const Deck& deck, std::uint32_t file, std::size_t offset);

/// An error at this place.
Error error_at(const Deck& deck, std::uint32_t file, std::size_t offset, std::string message);

/// An error at this place that refuses to save: its message ends with "; nothing was written".
Error refusal_at(const Deck& deck, std::uint32_t file, std::size_t offset, const std::string& message);

/// The same for the deck as a whole: at its main file, without a line.
Error refusal(const Deck& deck, const std::string& message);

/// What a refusal to save says, without "; nothing was written": for edits that were done otherwise.
std::string reason_of(const Error& refusal);

/// The result of a check; its error becomes a refusal to save.
Result<void> as_refusal(Result<void> checked);

}  // namespace prismesh::mesh::deck
