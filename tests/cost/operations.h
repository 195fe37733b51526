// The operations whose cost is counted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mesh/document/document.h"

namespace prismesh::cost {

/// What the operations work on, at one size. Files are in a folder of the program's own.
struct Inputs {
  std::filesystem::path folder;
  mesh::Model sheet;                ///< flat_sheet
  mesh::document::Document rails;   ///< the rails, read from Nastran; nothing is selected
  mesh::document::Document pulled;  ///< the same with the top of the first rail selected and lifted
  mesh::document::Document sample;  ///< the generated sample, read from LS-DYNA
};
Inputs make_inputs(const std::filesystem::path& folder, std::size_t shells);

/// What is counted; runs once.
using Work = std::function<void()>;

struct Operation {
  std::string name;
  std::function<Work(const Inputs&)> prepare;  ///< not counted. The inputs must outlive the result
};
const std::vector<Operation>& operations();

}  // namespace prismesh::cost
