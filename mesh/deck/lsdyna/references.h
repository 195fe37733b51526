// Collects what cards name: nodes, elements, parts and sets, except for what elements name themselves (LS-DYNA keyword manual, volume I).
// Tables tell which field names what (reference_tables.h).
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

/// Notes the blocks during the walk over the deck; reads them afterwards, in parallel.
class ReferenceReader {
 public:
  /// Notes a block. To be called for every block of every file, in the solver's order. `parameters`: as known at the block; `offsets`: of
  /// the include it stands in.
  void read(std::uint32_t file, const Block& block, const Parameters& parameters, const IdOffsets& offsets = {});
  /// Notes an encrypted part [begin, end) of a block of nodes or elements. Those in other blocks are found here.
  void encrypted(std::uint32_t file, const Block& block, std::size_t begin, std::size_t end);
  /// Reads all blocks. Returns what they name, in the deck's order, without References::finish. Empties this.
  References finish(std::span<const SourceFile> files);

 private:
  /// A block to read; small, since there may be millions.
  struct Job {
    const ReferenceRule* rule = nullptr;  ///< null: no rule covers it
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
