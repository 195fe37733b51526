// Replaces the segments on shells that an edit reshapes, divides or removes.
#pragma once

#include <set>
#include <vector>

#include "base/error.h"
#include "mesh/deck/editing/model_difference.h"
#include "mesh/deck/editing/reference_plan.h"
#include "mesh/deck/editing/text_edits.h"

namespace prismesh::mesh::deck {

struct SegmentChanges {
  std::vector<FileReplacement> replacements;
  std::set<CardLine> lines;  ///< of the segments that are replaced
};

/// A segment on a shell becomes segments on what the shell has become, the same way around. Errors: the text of a segment can't be
/// changed (file and line).
Result<SegmentChanges> segment_changes(const ModelDifference& difference, const ShellFamilies& families);

}  // namespace prismesh::mesh::deck
