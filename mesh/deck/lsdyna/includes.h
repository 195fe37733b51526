// *INCLUDE: which file a name means, and what *INCLUDE_TRANSFORM makes of what it holds.
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
  std::size_t offset = 0;  ///< of the line it stands on
};

/// The names in an *INCLUDE, *INCLUDE_PATH... block; a line that ends in " +" goes on in the next. `only_first`: the block
/// has other cards after its one name.
std::vector<IncludeName> include_names(std::string_view text, const Block& block, bool only_first);

/// What becomes of the cards of an include: everything the includes around it do is counted in, but for the transformation.
struct IncludeContext {
  std::uint32_t parent = 0;
  std::uint32_t file = 0;  ///< of the *INCLUDE_TRANSFORM
  std::size_t offset = 0;
  IdOffsets offsets;
  double mass = 1, time = 1, length = 1;  ///< what the file's units are multiplied with
  double own_length = 1;                  ///< of this include alone
  std::int64_t transformation = 0;        ///< of this include alone, as written; 0: none
  std::string prefix, suffix;             ///< of titles, each with its dot

  /// Whether it does the same as another at another place.
  bool same_as(const IncludeContext& other) const;
};

/// What an *INCLUDE_TRANSFORM says, without what of it can't be used.
struct IncludeTransform {
  IncludeContext context;
  std::string problem;  ///< what can't be used, as the end of a sentence; empty: nothing
};

/// An *INCLUDE_TRANSFORM in a file that is in contexts[parent] itself.
IncludeTransform read_transform(std::string_view text, const Block& block, const Parameters& parameters,
                                std::span<const IncludeContext> contexts, std::uint32_t parent);

/// Where includes are looked for: beside the file that names them, beside the main file, then along the paths.
class IncludeSearch {
 public:
  explicit IncludeSearch(std::filesystem::path main_folder) : main_folder_(std::move(main_folder)) {}
  void add_path(const std::string& path);
  /// In the order they are looked through for what a file in `from_folder` names.
  std::vector<std::filesystem::path> folders(const std::filesystem::path& from_folder) const;

 private:
  std::filesystem::path main_folder_;
  std::vector<std::filesystem::path> paths_;
};

}  // namespace prismesh::mesh::deck::lsdyna
