// Prepares an edit, and commits it as the current generation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"

namespace prismesh::mesh::document {

/// A prepared edit. It can be journalled before it is committed.
struct Prepared {
  std::shared_ptr<const Generation> next;  ///< for undo and redo: the generation to go to
  enum class Step : std::uint8_t { push, undo, redo, branch } step = Step::push;
  std::size_t drop_oldest = 0;    ///< generations to drop on commit, so that the history keeps its byte cap
  std::size_t drop_branches = 0;  ///< the same for branches, counted with the one that the commit makes
  std::uint64_t branch = 0;       ///< of step branch: its number
  EditReport report;
  std::optional<Edit> as_done;  ///< what to journal, if that isn't the edit: a repair that was stopped, with the place
};

/// Applies the edit to a copy of the current generation; the document doesn't change. Deterministic. `progress` is called by relax, repair
/// and select, which may take long. `clock` may be null: the report's milliseconds stay 0. Errors: expression:column, nothing selected, a
/// locked or held node would move (named), nothing to undo, cancelled. A cancelled repair may be kept (docs/repairing.md).
Result<Prepared> prepare(const Document& document, const Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);
/// Makes it the current generation. What could be redone becomes a branch; over the byte cap the oldest branches are dropped, then the
/// oldest generations. Can fail only for lack of memory.
void commit(Document& document, Prepared prepared);
/// prepare, then commit.
Result<EditReport> apply(Document& document, const Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);

}  // namespace prismesh::mesh::document
