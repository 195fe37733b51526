// Reads the mesh that takes a part's place from another deck. Private to mesh/document.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

/// The same edit with the mesh that it names, and with coordinates for the nodes of the variant that align it; as it is if it has the mesh.
/// The coordinates of the mesh are those of the variant. Errors: those of the variant's deck (file and line); it has no such part; the part
/// isn't whole; its lengths have another unit.
Result<ReplacePart> with_mesh(const Document& document, const ReplacePart& edit, const Progress& progress);

/// Moves the mesh so that it is aligned; as it stands it stays. Errors: a node isn't there, three points lie on a line, or the points
/// are of different sizes. `deck`: of the nodes in Alignment::to.
Result<void> align_mesh(const Model& deck, const Alignment& align, VariantMesh& mesh);

}  // namespace prismesh::mesh::document
