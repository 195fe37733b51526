// Checks what a hand-over says of a deck, before anything uses it as an index, an offset or an order.
#pragma once

#include <string>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/model/model.h"
#include "mesh/model/references.h"

namespace prismesh::ipc {

/// References as they were handed over, not yet in order.
struct HandedReferences {
  std::vector<mesh::Referrer> referrers;
  std::vector<mesh::Reference> references;
  std::vector<mesh::UnreadText> unread;
};

/// The first fault, in words; empty: there is none. Then every index is below its count (or says "none" where it may), every offset lies in
/// the text of its file, what has to ascend ascends, numbers are finite, and relative names stay in their folder. Ids of nodes may still be
/// equal. The codes of cards' styles aren't checked: only the writers of cards know them.
std::string fault_of(const mesh::deck::Deck& deck, const HandedReferences& references, const mesh::Model& model);

}  // namespace prismesh::ipc
