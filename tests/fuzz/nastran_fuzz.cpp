// Any bytes as Nastran bulk data: see deck_fuzz.h. Eight columns keep five digits of a negative coordinate with an exponent.
#include "tests/fuzz/deck_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prismesh::fuzz::try_deck(prismesh::mesh::deck::Format::nastran, "deck.bdf", data, size, 1e-3);
  return 0;
}
