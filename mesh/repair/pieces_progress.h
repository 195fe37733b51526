// The progress of a repair's pieces, which run on several threads, as one.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mesh/repair/pieces.h"

namespace prismesh::mesh::repair {

/// How far a piece is.
struct PieceStatus {
  int round = 1;             ///< from 1
  std::size_t bad_left = 0;  ///< shells of the scope that fail or warn
};

/// Sums the pieces' progress by their work. Once the repair's progress says stop, it is over for all pieces.
class PiecesProgress {
 public:
  PiecesProgress(const std::vector<Piece>& pieces, const Progress& progress);

  /// The progress of a piece, to be called on any thread; `wake` has to lead to a call of `report`, and has to live as long as the piece's
  /// progress. `status` is called on the piece's thread, once for each time that words were asked for. Empty if the repair's is.
  Progress of(std::size_t piece, const std::function<void()>& wake, std::function<PieceStatus()> status);
  /// Tells that a piece has ended, and with how many shells that fail or warn.
  void ended(std::size_t piece, std::size_t bad_left, const std::function<void()>& wake);
  /// Calls the repair's progress, on the thread that started the repair.
  void report();

 private:
  struct State {
    double share = 0;  ///< of the work
    std::atomic<double> done = 0;
    std::atomic<int> round = 1;
    std::atomic<std::size_t> bad_left = 0;  ///< when words were last asked for
    std::atomic<bool> is_asked = false;     ///< for its status
  };
  std::string words();

  const Progress& progress_;
  std::vector<State> pieces_;
  std::size_t bad_before_ = 0;
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace prismesh::mesh::repair
