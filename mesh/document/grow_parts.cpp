#include "mesh/document/grow_parts.h"

#include <memory>
#include <utility>
#include <vector>

namespace prismesh::mesh::document {

void grow_parts(std::size_t count, Generation& generation) {
  if (generation.parts && generation.parts->size() < count) {
    auto states = std::make_shared<std::vector<PartState>>(*generation.parts);
    states->resize(count);
    generation.parts = std::move(states);
  }
  if (generation.judging && generation.judging->parts.size() < count) {
    auto judging = std::make_shared<Judging>(*generation.judging);
    judging->parts.resize(count);
    judging->guessed.resize(count, {judging->guessed_size, nullptr, quality::SizeFrom::deck});
    settle(*judging);
    generation.judging = std::move(judging);
  }
}

}  // namespace prismesh::mesh::document
