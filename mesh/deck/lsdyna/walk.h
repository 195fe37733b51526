// The walk over a deck's files in the order the solver reads them: everything but the mesh is read on the way, the mesh is
// noted as pieces to be read in parallel.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/deck.h"
#include "mesh/deck/lsdyna/definitions.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/lsdyna/warnings.h"

namespace prismesh::mesh::deck::lsdyna {

class Walk {
 public:
  /// `cut_out_encrypted`: look for encrypted blocks among the mesh (that takes a pass over it, and hardly any deck has them).
  Walk(std::filesystem::path path, FileBytes main, bool cut_out_encrypted);
  void run();

  std::vector<SourceFile> files;
  std::vector<Piece> pieces;
  std::vector<Parameters> parameter_tables;  ///< what the segments' `parameters` index
  Definitions definitions;
  Warnings warnings;
  std::vector<std::string> missing_files;

 private:
  void hold_repeated();
  void walk_file(std::uint32_t file, Columns columns, int depth);
  void read_block(std::uint32_t file, const Block& block, Columns columns, int depth);
  void add_mesh(std::uint32_t file, const Block& block, const CardForm& form);
  void add_segment(std::uint32_t file, const Segment& segment);
  void include(std::uint32_t from, const Block& block, Columns columns, int depth);
  void include_one(std::uint32_t from, const IncludeName& name, Columns columns, int depth, bool read);
  std::uint32_t find_file(std::uint32_t from, const std::string& name, std::string& reason);
  std::uint32_t open_file(const std::filesystem::path& found, const std::string& name, std::string& reason);

  std::filesystem::path main_folder_;
  bool cut_out_encrypted_;
  IncludeSearch search_;
  Parameters parameters_;
  std::map<std::string, std::uint32_t> by_canonical_;
  std::map<std::pair<std::uint32_t, std::string>, std::uint32_t> known_;  ///< by the file that names it, and the name

  /// By file.
  struct State {
    bool walked = false;
    bool open = false;  ///< being walked right now
    bool has_mesh = false;
    int uses = 0;
    std::vector<std::uint32_t> includes;
  };
  std::vector<State> states_;
};

}  // namespace prismesh::mesh::deck::lsdyna
