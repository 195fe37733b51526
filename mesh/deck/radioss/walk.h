// Walks over a deck's files in the solver's order: finds the blocks, follows includes and submodels. Interprets nothing else.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/context.h"

namespace prismesh::mesh::deck::radioss {

class Walk {
 public:
  explicit Walk(FileSet found);
  void run();

  FileSet files;
  std::vector<Block> blocks;  ///< up to /END, in their order, without the keywords of submodels
  std::vector<Context> contexts{Context()};
  std::vector<bool> held;  ///< by file: whether its content stands for several places of the model
  Warnings warnings;

 private:
  void walk_file(std::uint32_t file, int depth);
  void keyword(std::uint32_t file, std::size_t offset);
  void include(std::uint32_t file, std::size_t offset, int depth);
  void close_stretch(std::size_t end);
  void finish_block();
  void find_files(const Block& block, const Keyword& keyword);
  void find_engine_files();
  void begin_submodel(const Block& block, const Keyword& keyword);
  void end_submodel(std::uint32_t file, std::size_t offset);
  void read_begin(const Block& block);

  std::filesystem::path main_folder_;
  bool ended_ = false;  ///< the rest of the file being walked isn't read
  bool in_block_ = false;
  Block block_;
  Keyword keyword_;
  Stretch stretch_;  ///< the part of the block being read
  bool first_stretch_ = false;
  std::uint32_t context_ = 0;
  std::size_t repeated_bytes_ = 0;

  struct FileState : FileUse {
    bool open = false;
  };
  std::vector<FileState> states_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> walked_;  ///< file and context
};

}  // namespace prismesh::mesh::deck::radioss
