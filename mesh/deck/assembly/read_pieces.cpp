#include "mesh/deck/assembly/read_pieces.h"

#include <atomic>

#include "base/parallel_for.h"

namespace prismesh::mesh::deck {

void read_pieces(DeckContents& found, std::size_t pieces, const std::function<PieceCards(std::size_t)>& read, Watch& watch) {
  found.cards.resize(pieces);
  found.hashes.resize(found.files.size());
  std::atomic<std::size_t> done = 0;
  const std::size_t jobs = found.files.size() + pieces;
  parallel_for(jobs, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t job = begin; job < end && !watch.stopped(); ++job) {
      if (job < found.files.size())
        found.hashes[job] = hash128(found.files[job].bytes.bytes());
      else
        found.cards[job - found.files.size()] = read(job - found.files.size());
      watch.tell(kWalked + (kRead - kWalked) * static_cast<double>(++done) / static_cast<double>(jobs));
    }
  });
  watch.tell(kRead);
}

}  // namespace prismesh::mesh::deck
