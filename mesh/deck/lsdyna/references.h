// Every card of a keyword deck that names nodes, elements, parts or sets, besides the elements themselves (LS-DYNA keyword manual,
// volume I). What a card names is told by tables: see reference_tables.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::lsdyna {

struct ReferenceRule;

/// Notes the blocks while the deck is walked over; reads them afterwards, in parallel.
class ReferenceReader {
 public:
  /// Every block of every file, in the order the solver reads them; `parameters` as they stand there, `offsets` of the include it is in.
  void read(std::uint32_t file, const Block& block, const Parameters& parameters, const IdOffsets& offsets = {});
  /// An encrypted block among nodes or elements (those in other blocks are found here).
  void encrypted(std::uint32_t file, const Block& block, std::size_t begin, std::size_t end);
  /// What the cards name, in the deck's order; not yet finished. Empties this.
  References finish(std::span<const SourceFile> files);

 private:
  /// A block to be read; there may be millions.
  struct Job {
    const ReferenceRule* rule = nullptr;  ///< null: nobody understands it
    std::size_t keyword = 0;              ///< offsets as in Block
    std::size_t begin = 0;
    std::size_t end = 0;
    std::uint32_t file = 0;
    std::uint32_t parameters = 0;  ///< index into parameters_
    std::uint32_t offsets = 0;     ///< index into offsets_
    std::uint16_t name_length = 0;
    Columns columns = Columns::standard;
    bool encrypted = false;
  };
  bool extends_last(const Job& job) const;
  void read_job(const Job& job, std::string_view text, References& out) const;

  std::vector<Job> jobs_;
  std::vector<Parameters> parameters_;
  std::vector<IdOffsets> offsets_;
};

}  // namespace prismesh::mesh::deck::lsdyna
