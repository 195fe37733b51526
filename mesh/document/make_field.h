// The field that is wanted of a generation.
#pragma once

#include <string>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/field.h"
#include "mesh/document/field_wish.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::document {

/// What an expression names as a shape: shells, parts, sets of those and files count with their surfaces (and with the nodes of their
/// other elements); as soon as it names anything else, with all its nodes. Errors: those of select::evaluate.
Result<spatial::Shape> shape_named(const Generation& generation, const std::string& expression);

/// The wished field of a generation. `other`: what it is compared with; needed where needs_other says so.
Result<Field> make_field(const FieldWish& wish, const Generation& generation, const Document& document, const Model* other,
                         const Progress& progress = {});

}  // namespace prismesh::mesh::document
