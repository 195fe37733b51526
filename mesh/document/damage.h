// Finds the shells that a document's edits made worse.
#pragma once

#include <memory>

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Shells of the current generation that fail or warn by a metric by which they (for a new shell: the deck's shell it descends from) were
/// better when the deck was opened. Costs the chunks that differ.
ShellSet damaged_shells(const Document& document);

/// The deck as it was opened, with its shells judged as those of the generation are: a change of a target size makes no shell worse.
/// `opened` itself where they are judged alike.
std::shared_ptr<const Generation> opened_as_judged(const Document& document, const Generation& generation);

}  // namespace prismesh::mesh::document
