// Reads a daemon's command line: --help, --version, and options that each take a path.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh {

struct ProgramUsage {
  std::string name;                         ///< of the program
  std::string usage;                        ///< lines of text
  std::vector<std::string_view> with_path;  ///< "--runtime-dir", ...
};

struct ProgramOptions {
  std::map<std::string, std::filesystem::path, std::less<>> paths;
  /// The exit status, if the program has to end now: help or version was asked for and printed, or the command line is wrong and the
  /// error is on standard error.
  std::optional<int> end;

  std::optional<std::filesystem::path> path(std::string_view option) const;
};

ProgramOptions program_options(const ProgramUsage& use, int count, char** values);

}  // namespace prismesh
