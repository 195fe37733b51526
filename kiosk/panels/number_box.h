// The box that numbers are typed into.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kiosk/display/window.h"
#include "kiosk/panels/entry_box.h"

namespace prismesh::kiosk::panels {

struct NumberFacts {
  std::string title, hint;
  std::string begun;                    ///< the field's text when the box opens
  std::string problem;                  ///< a sentence; empty: none
  std::optional<Eigen::Vector2d> at{};  ///< the pointer, beside which the box stands; nothing: below the model
};

/// Lays the box out (inside Gui::layout). `opened`: it wasn't there the last time. Returns the text that was entered.
std::optional<std::string> number_box(const NumberFacts& facts, const Place& room, bool opened, EntryState& entry);

}  // namespace prismesh::kiosk::panels
