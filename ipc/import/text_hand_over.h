// The new text of an edited deck's files, as another process has made it. The process is not trusted: a hostile deck may have taken it
// over.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/text_changes.h"

namespace prismesh::ipc {

std::vector<std::byte> write_text_hand_over(const mesh::deck::TextChanges& text);

/// Reads and checks new text for the files of `deck`. `nodes`: how many nodes the edited model has. `bytes` must not change meanwhile. What
/// isn't checked: whether the text says what the model is. Errors: what is wrong with it, in a sentence. Uses memory in proportion to the
/// bytes. Throws std::bad_alloc.
Result<mesh::deck::TextChanges> read_text_hand_over(std::span<const std::byte> bytes, const mesh::deck::Deck& deck, std::size_t nodes);

}  // namespace prismesh::ipc
