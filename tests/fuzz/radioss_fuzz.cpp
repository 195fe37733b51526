// Any bytes as a Radioss starter deck: see deck_fuzz.h.
#include "tests/fuzz/deck_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prismesh::fuzz::try_deck(prismesh::mesh::deck::Format::radioss, "deck_0000.rad", data, size);
  return 0;
}
