// Plans the motion of a shaping edit, for dragging and applying alike. Private to mesh/document.
#pragma once

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"
#include "mesh/document/motion.h"

namespace prismesh::mesh::document {

/// The motion of a shaping edit on a generation. `named_by` may be null; with it an error names the file and line of the card that holds a
/// node. Errors: nothing acted on, no such grab, a locked or held node would move, no normal at the grab of a lift.
Result<Motion> plan_motion(const Generation& generation, const Edit& edit, const deck::Deck* named_by);

}  // namespace prismesh::mesh::document
