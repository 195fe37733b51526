// Working out an edit, and making it the current generation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/clock.h"
#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"

namespace prismesh::mesh::document {

/// What an edit would do, before anyone knows of it: so that it can be journalled first.
struct Prepared {
  std::shared_ptr<const Generation> next;  ///< for undo and redo: the generation gone to
  enum class Step : std::uint8_t { push, undo, redo } step = Step::push;
  std::size_t drop_oldest = 0;  ///< generations that go when this one comes, so that the history keeps its byte cap
  EditReport report;
};

/// Works the edit out on the current generation; the document doesn't change. Deterministic. Errors: expression:column,
/// nothing selected, a locked or held node would move (named), nothing to undo, cancelled. `progress` hears of relax and repair, which may
/// take long; the other edits don't look at it. `clock` may be null: the report's milliseconds stay 0.
Result<Prepared> prepare(const Document& document, const Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);
/// Makes it the current generation; drops redo and, over the byte cap, the oldest generations. Can't fail.
void commit(Document& document, Prepared prepared);
/// prepare, then commit.
Result<EditReport> apply(Document& document, const Edit& edit, const Progress& progress = {}, Clock* clock = nullptr);

}  // namespace prismesh::mesh::document
