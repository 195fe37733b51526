// Compares two decks: `prismesh diff`, and the same from Python.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/deck/open.h"
#include "mesh/report/figures.h"

namespace prismesh::mesh::report {

/// What differs in the second deck. Nodes and elements are matched by their ids, include files by their paths in the deck.
struct Difference {
  std::size_t nodes_moved = 0;
  double max_displacement = 0;
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t elements_added = 0;
  std::size_t elements_removed = 0;
  std::size_t elements_changed = 0;  ///< shells in both with other corners
  std::size_t lines_changed = 0;
  std::vector<std::int64_t> moved, added, removed;                         ///< ids of nodes, ascending
  std::vector<std::int64_t> shells_added, shells_removed, shells_changed;  ///< ids of shells, ascending
  std::optional<FieldFigures> displacement;                                ///< of nodes in both; absent if there are none
  std::optional<FieldFigures> surface_distance;  ///< of the second deck's shell corners from the first deck's shells
};

Difference compare(const deck::OpenedDeck& a, const deck::OpenedDeck& b);

}  // namespace prismesh::mesh::report
