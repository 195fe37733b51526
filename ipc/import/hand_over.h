// A deck that another process has read, in sealed memory: every array of Deck and Model, and the text of the files. The process is not
// trusted: a hostile deck may have taken it over.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "mesh/deck/open.h"

namespace prismesh::ipc {

std::size_t hand_over_size(const mesh::deck::OpenedDeck& opened);
/// Writes the deck into `out`, which has just its size.
void write_hand_over(const mesh::deck::OpenedDeck& opened, std::span<std::byte> out);

/// Reads and checks a deck that was handed over. `bytes` must not change meanwhile. The deck's files get paths in `folder`. What follows
/// from the rest (indices by id, adjacency, hashes) is computed here, not taken over. Errors: what is wrong with it, in a sentence. Uses
/// memory in proportion to the bytes. Throws std::bad_alloc.
Result<mesh::deck::OpenedDeck> read_hand_over(std::span<const std::byte> bytes, const std::filesystem::path& folder);

}  // namespace prismesh::ipc
