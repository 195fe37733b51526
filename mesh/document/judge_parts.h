// Judges the shells again whose part is judged otherwise than before. Private to mesh/document.
#pragma once

#include <memory>

#include "mesh/document/generation.h"
#include "mesh/document/judging.h"

namespace prismesh::mesh::document {

/// Judges a generation by `judging` instead of its own: updates the states and counts of the shells whose part is judged otherwise, and the
/// clusters of triangles if the deck's limit is another one. Costs these shells.
void judge_by(std::shared_ptr<const Judging> judging, Generation& generation);

}  // namespace prismesh::mesh::document
