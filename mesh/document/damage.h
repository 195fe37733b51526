// What a document's edits made worse.
#pragma once

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Shells of `now` that fail or warn by a metric by which they (new ones: the shell of the deck that they descend from) were better in
/// `opened`. Costs the chunks that differ.
ShellSet damaged_shells(const Generation& opened, const Generation& now);

}  // namespace prismesh::mesh::document
