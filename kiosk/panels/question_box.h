// A question in the middle: what would happen to which files, and a button for each reply.
#pragma once

#include <optional>

#include "kiosk/panels/places.h"
#include "kiosk/panels/question.h"

namespace prismesh::kiosk::panels {

/// Lays the box out (inside Gui::layout). Returns the reply that was chosen.
std::optional<Reply> question_box(const Question& question, const Place& room);

}  // namespace prismesh::kiosk::panels
