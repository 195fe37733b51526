// Finds the shells that a document's edits made worse.
#pragma once

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Shells of `now` that fail or warn by a metric by which they (for a new shell: the deck's shell it descends from) were better in
/// `opened`. Costs the chunks that differ.
ShellSet damaged_shells(const Generation& opened, const Generation& now);

}  // namespace prismesh::mesh::document
