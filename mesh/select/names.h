// What expressions may name besides ids: a deck's sets and its files. Points into the deck; empty where there is none.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh/model/index.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::select {

struct Names {
  const References* references = nullptr;  ///< its sets; null: no sets
  std::vector<std::string> files;          ///< as the deck's SourceFile::relative, by number
  std::function<std::uint32_t(NodeIndex)> file_of_node;
  std::function<std::uint32_t(ShellIndex)> file_of_shell;
};

}  // namespace prismesh::mesh::select
