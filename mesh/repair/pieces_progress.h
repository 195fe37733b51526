// The progress of a repair's pieces, which run on several threads, as one.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "mesh/repair/pieces.h"

namespace prismesh::mesh::repair {

/// Sums the pieces' progress by their work. Once the repair's progress says stop, it is over for all pieces.
class PiecesProgress {
 public:
  PiecesProgress(const std::vector<Piece>& pieces, const Progress& progress);

  /// The progress of a piece, to be called on any thread; `wake` has to lead to a call of `report`, and has to live as long as the piece's
  /// progress. Empty if the repair's is.
  Progress of(std::size_t piece, const std::function<void()>& wake);
  /// Tells that a piece has ended.
  void ended(std::size_t piece, const std::function<void()>& wake);
  /// Calls the repair's progress, on the thread that started the repair.
  void report();

 private:
  const Progress& progress_;
  std::vector<double> share_;              ///< of the work, by piece
  std::vector<std::atomic<double>> done_;  ///< fraction of each piece
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace prismesh::mesh::repair
