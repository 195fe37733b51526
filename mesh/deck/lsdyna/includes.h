// *INCLUDE: which file a name means.
#pragma once

#include <filesystem>
#include <optional>
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

/// Whether an *INCLUDE_TRANSFORM block changes nothing: no offset, no factor, no transformation.
bool transform_is_identity(std::string_view text, const Block& block, const Parameters& parameters);

/// Where includes are looked for: beside the file that names them, beside the main file, then along the paths.
class IncludeSearch {
 public:
  explicit IncludeSearch(std::filesystem::path main_folder) : main_folder_(std::move(main_folder)) {}
  void add_path(const std::string& path);
  /// The file, if one is there.
  std::optional<std::filesystem::path> find(const std::string& name, const std::filesystem::path& from_folder) const;

 private:
  std::filesystem::path main_folder_;
  std::vector<std::filesystem::path> paths_;
};

}  // namespace prismesh::mesh::deck::lsdyna
