// Any bytes as an LS-DYNA deck: see deck_fuzz.h.
#include "tests/fuzz/deck_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prismesh::fuzz::try_deck(prismesh::mesh::deck::Format::ls_dyna, "deck.k", data, size);
  return 0;
}
