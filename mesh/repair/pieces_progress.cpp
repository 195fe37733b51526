#include "mesh/repair/pieces_progress.h"

#include <algorithm>
#include <utility>

namespace prismesh::mesh::repair {

PiecesProgress::PiecesProgress(const std::vector<Piece>& pieces, const Progress& progress) : progress_(progress), pieces_(pieces.size()) {
  double all = 0;
  for (const Piece& piece : pieces) all += static_cast<double>(piece.work);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces_[i].share = static_cast<double>(pieces[i].work) / std::max(all, 1.0);
    pieces_[i].bad_left = pieces[i].bad;
    bad_before_ += pieces[i].bad;
  }
}

Progress PiecesProgress::of(std::size_t piece, const std::function<void()>& wake, std::function<PieceStatus()> status) {
  if (!progress_) return {};
  return [this, &state = pieces_[piece], &wake, status = std::move(status)](double fraction) {
    if (is_stopped_) return false;
    state.done = std::max<double>(state.done, fraction);
    if (state.is_asked.exchange(false)) {
      const PieceStatus now = status();
      state.round = now.round;
      state.bad_left = now.bad_left;
    }
    wake();
    return !is_stopped_;
  };
}

void PiecesProgress::ended(std::size_t piece, std::size_t bad_left, const std::function<void()>& wake) {
  if (!progress_ || is_stopped_) return;
  pieces_[piece].done = 1;
  pieces_[piece].bad_left = bad_left;
  wake();
}

void PiecesProgress::report() {
  if (is_stopped_) return;
  double sum = 0;
  for (const State& piece : pieces_) sum += piece.share * piece.done;
  if (!progress_(std::min(sum, 1.0), [this] { return words(); })) is_stopped_ = true;
}

std::string PiecesProgress::words() {
  int round = 1;
  std::size_t bad_left = 0;
  for (State& piece : pieces_) {
    round = std::max<int>(round, piece.round);
    bad_left += piece.bad_left;
    piece.is_asked = true;
  }
  std::string words = "round " + std::to_string(round);
  if (bad_before_ == 0) return words;
  return words + ", " + std::to_string(bad_left) + " of " + std::to_string(bad_before_) + " bad elements left";
}

}  // namespace prismesh::mesh::repair
