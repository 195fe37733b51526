// The box that an id expression is typed into.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/entry_box.h"
#include "kiosk/panels/places.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::selection {

struct ExpressionFacts {
  struct Count {
    std::uint64_t nodes = 0, shells = 0, parts = 0;
  };
  const std::vector<std::string>* earlier = nullptr;  ///< entered before, oldest first
  std::string counted_for;                            ///< the text that count and problem are of
  std::optional<Count> count;
  std::string problem;
  long column = 0;  ///< of the problem, from 1; 0: not known
};

/// What the box remembers from one layout to the next.
struct ExpressionEntry {
  panels::EntryState field{};
  std::string told;  ///< the text that was last asked about
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
};

struct ExpressionTyped {
  std::string text;
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
};
struct ExpressionEntered {
  std::string text;
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct ExpressionAsked {
  std::optional<ExpressionTyped> typed;  ///< another text or kind than before
  std::optional<ExpressionEntered> entered;
};

/// Lays the box out (inside Gui::layout). `opened`: it wasn't there the last time.
ExpressionAsked expression_box(const ExpressionFacts& facts, const panels::Place& room, bool opened, ExpressionEntry& entry);

}  // namespace prismesh::kiosk::tools::selection
