// Walks over a deck's files in the order the solver reads them: finds the bulk data and the includes, and cuts the text into pieces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/nastran/piece_facts.h"
#include "mesh/deck/nastran/references.h"

namespace prismesh::mesh::deck::nastran {

/// Lines that structure a deck: BEGIN BULK, another BEGIN, executive control (SOL, CEND), ENDDATA and INCLUDE.
enum class MarkKind : std::uint8_t { begin_bulk, begin_other, executive, end_data, include };

struct Mark {
  std::size_t offset = 0;
  std::size_t next = 0;  ///< where the line after begins
  MarkKind kind = MarkKind::include;
};

/// All marks of a text, ascending. Searches every line, in parallel.
std::vector<Mark> find_marks(std::string_view text);

class Walk {
 public:
  explicit Walk(FileSet found);
  void run();

  FileSet files;
  std::vector<Piece> pieces;
  std::vector<bool> held;           ///< by file: it is used more than once
  bool has_statements = false;      ///< BEGIN BULK or executive control, which nothing but a deck has
  bool has_other_sections = false;  ///< or a sentence that begins with "Begin"
  ReferenceReader references;       ///< of the text outside the bulk data, and of bulk data that isn't read
  Warnings warnings;

 private:
  enum class Section : std::uint8_t { control, bulk, other, ended };
  void walk_file(std::uint32_t file, const std::vector<Mark>& marks, int depth);
  void take(std::uint32_t file, std::size_t begin, std::size_t end);
  void cut(std::uint32_t file, std::size_t begin, std::size_t end);
  std::size_t include(std::uint32_t from, const Mark& mark, int depth);
  void find_companions(std::uint32_t from, std::size_t begin, std::size_t end);
  void hold_repeated();

  Section section_ = Section::control;
  /// By file.
  struct WalkedFile : FileUse {
    bool walked = false;
    bool open = false;
  };
  std::vector<WalkedFile> walked_files_;
};

}  // namespace prismesh::mesh::deck::nastran
