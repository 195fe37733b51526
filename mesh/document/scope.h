// Finds the shells to relax or repair, and the surface that they must stay on. Private to mesh/document.
#pragma once

#include <string_view>

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::document {

/// The shells of a scope: for a selection the selected shells, or those at the selected nodes; for the failing or damaged ones these alone.
/// Errors: nothing is selected; the message begins with `edit`. If nothing fails or is damaged, that is no error.
Result<ShellSet> shells_in(const Document& document, Scope scope, std::string_view edit);

/// The surface of a generation around some of its shells, with a few rings more.
relax::ReferenceSurface surface_about(const Generation& generation, const ShellSet& shells, double feature_angle);

}  // namespace prismesh::mesh::document
