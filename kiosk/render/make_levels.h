// Makes levels of detail of a model as it is shown.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "kiosk/render/model_source.h"
#include "kiosk/render/shell_draws.h"

namespace prismesh::kiosk::render {

/// Needs no graphics; may run on any thread. Errors: cancelled. Throws std::bad_alloc.
Result<MadeLevels> make_levels(const ModelSource& source, const Progress& progress = {});

}  // namespace prismesh::kiosk::render
