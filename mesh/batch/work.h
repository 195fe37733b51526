// Works one variant: opens, edits, repairs, measures and writes a deck.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "base/clock.h"
#include "base/error.h"
#include "base/progress.h"
#include "mesh/batch/result.h"
#include "mesh/batch/study.h"
#include "mesh/document/document.h"
#include "mesh/report/figures.h"

namespace prismesh::mesh::batch {

/// Draws a document into a PNG, close to the box where there is one. Errors: why there is none; the variant is then without a picture, with
/// a note.
using Painter =
    std::function<Result<void>(const document::Document&, const std::filesystem::path&, const std::optional<report::PartFigures::Box>&)>;

/// Writes the variant's deck, and its picture if there is a painter, into `folder`. A refused edit is a result. Errors: the deck isn't what
/// was frozen any more; it can't be opened, measured or written; cancelled.
Result<VariantResult> work_variant(const Study& study, const Variants& variants, const Variant& variant,
                                   const std::filesystem::path& folder, const Painter& painter, Clock& clock,
                                   const Progress& progress = {});

}  // namespace prismesh::mesh::batch
