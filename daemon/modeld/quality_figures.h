// A generation's quality in figures: counts by metric, a histogram, what is worst, and parts.
#pragma once

#include "base/error.h"
#include "ipc/messages.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Costs a pass over the shells (of the damaged ones only, if those are asked for). Errors: no such metric, with the nearest name.
Result<ipc::Quality> quality_figures(const mesh::document::Document& document, const ipc::GetQuality& request);
/// Errors: as above.
Result<ipc::ShellsFound> find_shells(const mesh::document::Document& document, const ipc::FindShells& request);

}  // namespace prismesh::modeld
