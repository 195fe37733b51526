// How far it is from a shell to others over its sheet. Private to mesh/contact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// A shell, and the longest path to it that makes it a neighbour.
struct PathWish {
  ShellIndex shell;
  double max_length = 0;
};

/// For each wish 1 if a path of at most its length leads over the sheet from a corner of `from` to a corner of the shell, else 0. Paths go
/// along sides and diagonals of shells: over regular quads they are at most 8 % longer than the way over the surface. Costs the nodes up to
/// the longest path, less where all shells are reached before. Preconditions: the model has its adjacency; wishes ascend by shell.
std::vector<std::uint8_t> reached_over_sheet(const Model& model, ShellIndex from, std::span<const PathWish> wishes);

}  // namespace prismesh::mesh::contact
