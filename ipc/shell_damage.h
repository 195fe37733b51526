// What a snapshot says of each shell beside its quality: by which metrics the document's edits made it worse.
#pragma once

#include <memory>

#include "mesh/document/generation.h"

namespace prismesh::ipc {

/// Kept from one generation to the next, so that a chunk that didn't change stays the same chunk.
class ShellDamage {
 public:
  /// For each shell of `now` the bits of its state that the shell of the deck from which it descends hadn't in `opened`. Costs the chunks
  /// of states that differ from those seen last.
  const mesh::ChunkedArray<mesh::quality::ShellState>& of(const std::shared_ptr<const mesh::document::Generation>& opened,
                                                          const mesh::document::Generation& now);

 private:
  std::shared_ptr<const mesh::document::Generation> opened_;
  mesh::ChunkedArray<mesh::quality::ShellState> quality_;  ///< that damage_ is made of
  mesh::ChunkedArray<mesh::quality::ShellState> damage_;
};

}  // namespace prismesh::ipc
