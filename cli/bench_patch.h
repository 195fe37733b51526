// Chooses the nodes of a deck that `bench` edits. Inner to cli.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "cli/bench_figures.h"
#include "mesh/document/document.h"

namespace prismesh::cli {

/// Tries the middle of the parts with the most shells, with patches of about `wanted_nodes` (at least 1) and then smaller ones, until a
/// patch can be lifted. If none can, the result says why the first one can't. The same patch for the same deck. Errors: the deck has no
/// shells; cancelled.
Result<BenchPatch> find_bench_patch(const mesh::document::Document& document, std::size_t wanted_nodes, const Progress& progress);

}  // namespace prismesh::cli
