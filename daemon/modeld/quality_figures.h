// Sums up a generation's quality: counts by metric, a histogram, the worst shells, counts by part.
#pragma once

#include "base/error.h"
#include "ipc/messages.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Cost: one pass over the shells, or over the damaged ones if only those are asked for. Errors: unknown metric, with the nearest name.
Result<ipc::Quality> quality_figures(const mesh::document::Document& document, const ipc::GetQuality& request);
/// Returns the shells whose metric lies in the requested half-open interval [from, to), as an expression. Errors: as above.
Result<ipc::ShellsFound> find_shells(const mesh::document::Document& document, const ipc::FindShells& request);

}  // namespace prismesh::modeld
