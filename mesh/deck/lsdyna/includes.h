// Reads *INCLUDE and *INCLUDE_TRANSFORM: the names of the files, and how ids, units and positions of their cards change
// (LS-DYNA keyword manual, volume I).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

/// A file name that a block gives.
struct IncludeName {
  std::string name;
  std::size_t offset = 0;  ///< of its line
};

/// Whether a file's name goes on in the next line: `part` (trimmed) ends with a blank and a plus.
bool name_goes_on(std::string_view part);

/// The names in an *INCLUDE or *INCLUDE_PATH block. A line that ends in " +" goes on in the next. `only_first`: the block has one name,
/// then other cards.
std::vector<IncludeName> include_names(std::string_view text, const Block& block, bool only_first);

/// How the cards of an include are changed. Includes the changes by the includes around it, except for the transformation.
struct IncludeContext {
  std::uint32_t parent = 0;
  std::uint32_t file = 0;  ///< of the *INCLUDE_TRANSFORM
  std::size_t offset = 0;
  IdOffsets offsets;
  double mass = 1, time = 1, length = 1;  ///< factors of the file's units
  double own_length = 1;                  ///< of this include alone
  std::int64_t transformation = 0;        ///< of this include alone, as written; 0: none
  std::string prefix, suffix;             ///< of titles, each with its dot

  /// Whether both change cards in the same way, wherever they stand.
  bool same_as(const IncludeContext& other) const;
};

/// An *INCLUDE_TRANSFORM that was read. Values that can't be used are left out.
struct IncludeTransform {
  IncludeContext context;
  std::string problem;  ///< which value can't be used, as the end of a sentence; empty: none
};

/// Reads an *INCLUDE_TRANSFORM in a file whose own context is contexts[parent].
IncludeTransform read_transform(std::string_view text, const Block& block, const Parameters& parameters,
                                std::span<const IncludeContext> contexts, std::uint32_t parent);

/// The folders to search for includes: that of the file that names them, that of the main file, then the paths of *INCLUDE_PATH.
class IncludeSearch {
 public:
  explicit IncludeSearch(std::filesystem::path main_folder) : main_folder_(std::move(main_folder)) {}
  void add_path(const std::string& path);
  /// The folders to search for a name in a file of `from_folder`, in their order.
  std::vector<std::filesystem::path> folders(const std::filesystem::path& from_folder) const;

 private:
  std::filesystem::path main_folder_;
  std::vector<std::filesystem::path> paths_;
};

}  // namespace prismesh::mesh::deck::lsdyna
