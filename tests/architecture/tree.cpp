#include "tests/architecture/tree.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/support/places.h"

namespace prismesh::architecture {

std::filesystem::path project_root() { return test::source_folder(); }

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<SourceText> source_tree() {
  std::vector<SourceText> sources;
  for (const char* layer : {"base", "mesh", "drivers", "ipc", "daemon", "kiosk", "cli", "python", "tests"}) {
    const std::filesystem::path folder = project_root() / layer;
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() == ".h" || path.extension() == ".cpp")
        sources.push_back({path.lexically_relative(project_root()).generic_string(), read_text(path)});
    }
  }
  std::sort(sources.begin(), sources.end(), [](const SourceText& a, const SourceText& b) { return a.path < b.path; });
  return sources;
}

}  // namespace prismesh::architecture
