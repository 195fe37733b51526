// The product's modules: every folder that holds sources, and which modules it uses. The picture is in docs/architecture.md.
#pragma once

#include <string>
#include <vector>

namespace prismesh::architecture {

struct Module {
  std::string folder;             ///< from the project's root: "mesh/shape"
  std::vector<std::string> uses;  ///< folders of modules; what those use may be included too
};

const std::vector<Module>& modules();

/// What is wrong with a table of modules, as sentences: one named twice or without a source, a folder of sources that isn't named, a use of
/// an unknown module, a cycle. `folders`: the product's folders that hold sources.
std::vector<std::string> table_faults(const std::vector<Module>& table, const std::vector<std::string>& folders);

}  // namespace prismesh::architecture
