// Computes a field of a generation by name.
#pragma once

#include <string>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/field.h"
#include "mesh/document/field_wish.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::document {

/// The shape that an expression names: if it names only shells, parts, sets of these and files, their surfaces and the nodes of their other
/// elements; otherwise all its nodes. Errors: those of select::evaluate.
Result<spatial::Shape> shape_named(const Generation& generation, const std::string& expression);

/// `other`: the model to compare with; required if needs_other(wish).
Result<Field> make_field(const FieldWish& wish, const Generation& generation, const Document& document, const Model* other,
                         const Progress& progress = {});

}  // namespace prismesh::mesh::document
