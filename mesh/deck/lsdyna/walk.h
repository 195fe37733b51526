// Walks over a deck's files in the solver's order. Reads everything but the mesh on the way, and notes the mesh as pieces to be read in
// parallel.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/definitions.h"
#include "mesh/deck/lsdyna/generated_ids.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/lsdyna/references.h"
#include "mesh/deck/lsdyna/transformations.h"
#include "mesh/deck/lsdyna/unseen.h"

namespace prismesh::mesh::deck::lsdyna {

class Walk {
 public:
  /// `cut_out_encrypted`: search the mesh for encrypted parts. This takes another pass over it, and hardly any deck has them.
  Walk(FileSet found, bool cut_out_encrypted);
  void run();

  FileSet files;
  std::vector<Piece> pieces;
  std::vector<Parameters> parameter_tables;                ///< what the segments' `parameters` index
  std::vector<IncludeContext> contexts{IncludeContext()};  ///< what the segments' `frame` indexes; [0]: the main file's
  Transformations transformations;
  Definitions definitions;
  GeneratedIds generated;
  ReferenceReader references;  ///< finish() it once the walk is done
  Warnings warnings;

 private:
  void hold_repeated();
  /// A file as it is read at one place of the deck.
  struct Visit {
    std::uint32_t file = 0;
    std::uint32_t context = 0;  ///< index into contexts
    int depth = 0;
  };
  void walk_file(const Visit& visit, Columns columns);
  void read_block(const Visit& visit, const Block& block, Columns columns);
  void note_unseen(const Visit& visit, const Block& block, const Unseen& what);
  void tell_unseen();
  void add_mesh(const Visit& visit, const Block& block, const CardForm& form);
  void add_segment(std::uint32_t file, const Segment& segment);
  void include(const Visit& from, const Block& block, Columns columns);
  void include_transformed(const Visit& from, const Block& block, Columns columns);
  void include_one(const Visit& from, const IncludeName& name, Columns columns, std::uint32_t context);
  void keep_unread(const Visit& from, const Block& block);
  void find_companions(const Visit& from, const Block& block);
  void accompany(const Visit& from, const Block& block, const std::string& name, std::size_t offset, bool is_certain);
  bool may_walk_again(std::uint32_t file);

  bool cut_out_encrypted_;
  IncludeSearch search_;
  Parameters parameters_;

  /// By file.
  struct FileState : FileUse {
    std::set<std::uint32_t> walked;  ///< in which contexts
    bool open = false;               ///< being walked right now
    bool has_mesh = false;
  };
  std::vector<FileState> states_;
  struct UnseenLines {
    Unseen what;
    std::size_t offset = 0;  ///< of the first
    std::size_t lines = 0;
  };
  std::map<std::pair<std::uint32_t, std::string>, UnseenLines> unseen_;  ///< by file and keyword
  std::set<std::string, std::less<>> words_;                             ///< of the elements' keywords
  std::size_t walked_again_ = 0;                                         ///< bytes
  std::size_t walks_ = 0;
};

}  // namespace prismesh::mesh::deck::lsdyna
