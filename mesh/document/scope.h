// Which shells relaxing and repairing look at, and the surface they hold the mesh on. Private to mesh/document.
#pragma once

#include <string_view>

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::document {

/// The shells that a scope means: of a selection those at its nodes (selected shells themselves), of failing and damaged ones these alone.
/// Errors: nothing is selected; the sentence begins with `edit`. Nothing failing or damaged is no error.
Result<ShellSet> shells_in(const Document& document, Scope scope, std::string_view edit);

/// The surface of a generation about some of its shells and a few rings more.
relax::ReferenceSurface surface_about(const Generation& generation, const ShellSet& shells, double feature_angle);

}  // namespace prismesh::mesh::document
