#include "mesh/repair/pieces_progress.h"

#include <algorithm>

namespace prismesh::mesh::repair {

PiecesProgress::PiecesProgress(const std::vector<Piece>& pieces, const Progress& progress)
    : progress_(progress), share_(pieces.size()), done_(pieces.size()) {
  double all = 0;
  for (const Piece& piece : pieces) all += static_cast<double>(piece.work);
  for (std::size_t i = 0; i < pieces.size(); ++i) share_[i] = static_cast<double>(pieces[i].work) / std::max(all, 1.0);
}

Progress PiecesProgress::of(std::size_t piece, const std::function<void()>& wake) {
  if (!progress_) return {};
  return [this, piece, &wake](double fraction) {
    if (is_stopped_) return false;
    done_[piece] = std::max<double>(done_[piece], fraction);
    wake();
    return !is_stopped_;
  };
}

void PiecesProgress::ended(std::size_t piece, const std::function<void()>& wake) {
  if (!progress_ || is_stopped_) return;
  done_[piece] = 1;
  wake();
}

void PiecesProgress::report() {
  if (is_stopped_) return;
  double sum = 0;
  for (std::size_t i = 0; i < share_.size(); ++i) sum += share_[i] * done_[i];
  if (!progress_(std::min(sum, 1.0))) is_stopped_ = true;
}

}  // namespace prismesh::mesh::repair
