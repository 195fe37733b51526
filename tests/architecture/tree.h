// The project's own files, for tests about the project.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prismesh::architecture {

/// A C++ file of the project; the path is relative to the project's root.
struct SourceText {
  std::string path;
  std::string text;
};

std::filesystem::path project_root();
std::string read_text(const std::filesystem::path& path);

/// Every .h and .cpp of the product and its tests, ascending by path.
std::vector<SourceText> source_tree();

}  // namespace prismesh::architecture
