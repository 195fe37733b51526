#include "base/program_options.h"

#include <algorithm>
#include <cstdio>

namespace prismesh {

std::optional<std::filesystem::path> ProgramOptions::path(std::string_view option) const {
  const auto found = paths.find(option);
  if (found == paths.end()) return std::nullopt;
  return found->second;
}

ProgramOptions program_options(const ProgramUsage& use, int count, char** values) {
  ProgramOptions options;
  if (count == 2 && std::string_view(values[1]) == "--help") {
    std::fputs(use.usage.c_str(), stdout);
    options.end = 0;
    return options;
  }
  if (count == 2 && std::string_view(values[1]) == "--version") {
    std::puts((use.name + " " PRISMESH_VERSION).c_str());
    options.end = 0;
    return options;
  }
  for (int i = 1; i < count; i += 2) {
    const std::string_view option = values[i];
    const bool known = std::find(use.with_path.begin(), use.with_path.end(), option) != use.with_path.end();
    if (!known || i + 1 == count) {
      const std::string problem = known ? " needs a path behind it\n" : " is no option of " + use.name + "\n";
      std::fputs((std::string(option) + problem).c_str(), stderr);
      std::fputs(use.usage.c_str(), stderr);
      options.end = 2;
      return options;
    }
    options.paths.insert_or_assign(std::string(option), values[i + 1]);
  }
  return options;
}

}  // namespace prismesh
