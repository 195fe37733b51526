// What the readers of all formats have in common: what they find, and reading pieces of text in parallel.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/hash.h"
#include "base/progress.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Tells the progress from the thread that started the work only, and remembers that it was told to stop.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress), thread_(std::this_thread::get_id()) {}
  void tell(double fraction) {
    if (progress_ && std::this_thread::get_id() == thread_ && !progress_(fraction)) stopped_ = true;
  }
  bool stopped() const { return stopped_; }

 private:
  const Progress& progress_;
  std::thread::id thread_;
  std::atomic<bool> stopped_ = false;
};

// How far each phase of opening brings the progress: about its share of the time.
inline constexpr double kWalked = 0.2;
inline constexpr double kRead = 0.6;
inline constexpr double kAssembled = 0.75;

/// About as much text as one piece should have: enough to be worth a thread's while, and enough pieces for every thread.
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Everything a format's reader has found, to be made into a deck and a model.
struct DeckContents {
  Format format = Format::ls_dyna;
  std::vector<SourceFile> files;
  std::vector<Hash128> hashes;  ///< of the files; read_pieces makes them
  std::vector<PieceCards> cards;
  std::vector<Frame> frames{Frame()};  ///< [0]: the basic system
  std::vector<IdOffsets> id_offsets;   ///< as Deck::id_offsets
  std::vector<Part> parts;             ///< defined ones, ascending by id
  References references;
  TimeStepControl time_step;
  std::optional<LengthUnit> length_unit;  ///< where the deck itself says so
  Warnings warnings;
  std::vector<std::string> missing_files;
};

/// Hashes all files and reads all pieces, in parallel: fills `hashes` and `cards`. `read(i)` is called once for each piece, from any
/// thread. The progress goes to about 0.6.
void read_pieces(DeckContents& found, std::size_t pieces, const std::function<PieceCards(std::size_t)>& read, Watch& watch);

}  // namespace prismesh::mesh::deck
