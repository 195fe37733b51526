// The cards that name a file to read besides *INCLUDE.
// Source: LS-DYNA Keyword User's Manual, the pages of the keywords; places of names as in the tables of ansys/pydyna.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

struct NamedFile {
  std::string name;
  std::size_t offset = 0;   ///< of the line with it
  bool is_certain = false;  ///< false: the line may say something else, or the solver may write the file
};

/// The files that a block names, or may name: then each of its first lines counts as a name. Empty: the keyword names none.
std::vector<NamedFile> named_files(std::string_view text, const Block& block);

}  // namespace prismesh::mesh::deck::lsdyna
