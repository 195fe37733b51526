// Any bytes as Abaqus input: see deck_fuzz.h.
#include "tests/fuzz/deck_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prismesh::fuzz::try_deck(prismesh::mesh::deck::Format::abaqus, "deck.inp", data, size);
  return 0;
}
