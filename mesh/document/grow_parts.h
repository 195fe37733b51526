// What a generation knows of each part, for parts that an edit adds. Private to mesh/document.
#pragma once

#include <cstddef>

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Appends states and judging of new parts, up to `count` parts: seen, unlocked, judged as all parts are, with the deck's guessed size.
void grow_parts(std::size_t count, Generation& generation);

}  // namespace prismesh::mesh::document
