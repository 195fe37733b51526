// What a daemon is started with: --help, --version, and options that each take a path.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh {

struct ProgramUse {
  std::string name;                         ///< of the program
  std::string usage;                        ///< lines of text
  std::vector<std::string_view> with_path;  ///< "--runtime-dir", ...
};

struct ProgramOptions {
  std::map<std::string, std::filesystem::path, std::less<>> paths;
  /// Set: the program has nothing to do but end so, because help or version was asked for (and printed), or its use was wrong (and told
  /// on standard error).
  std::optional<int> end;

  std::optional<std::filesystem::path> path(std::string_view option) const;
};

ProgramOptions program_options(const ProgramUse& use, int count, char** values);

}  // namespace prismesh
