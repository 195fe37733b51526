// Finds for each shell the metrics by which the document's edits made it worse.
#pragma once

#include <memory>

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Keeps its result from one generation to the next, so that an unchanged chunk stays the same chunk.
class ShellDamage {
 public:
  /// For each shell of `now` the bits of its state that the deck's shell it descends from didn't have in `opened`. Costs the chunks of
  /// states that changed since the last call.
  const ChunkedArray<quality::ShellState>& of(const std::shared_ptr<const Generation>& opened, const Generation& now);

 private:
  std::shared_ptr<const Generation> opened_;
  ChunkedArray<quality::ShellState> quality_;  ///< that damage_ is made of
  ChunkedArray<quality::ShellState> damage_;
};

}  // namespace prismesh::mesh::document
