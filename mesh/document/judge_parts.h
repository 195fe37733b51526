// Judges the shells again whose part is judged otherwise than before. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"
#include "mesh/document/judging.h"

namespace prismesh::mesh::document {

/// Updates `states` and `counts` of a model's shells, which `before` judged, to what `now` says. Costs the shells of the parts that are
/// judged otherwise.
void rejudge_parts(const Model& model, const quality::Criteria& criteria, const Judging& before, const Judging& now,
                   ChunkedArray<quality::ShellState>& states, quality::Counts& counts);

}  // namespace prismesh::mesh::document
