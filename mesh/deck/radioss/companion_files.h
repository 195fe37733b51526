// The blocks that name a file to read besides #include.
// Source: Radioss Reference Guide, the pages of the keywords; OpenRadioss, "starter/source" and "hm_cfg_files".
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/deck/radioss/block.h"

namespace prismesh::mesh::deck::radioss {

struct NamedFile {
  std::string name;
  std::size_t offset = 0;   ///< of the line with it, in the block's file
  bool is_mesh = false;     ///< its nodes and elements become part of the model
  bool is_certain = false;  ///< false: the line may say something else, or the program may write the file
};

/// The files that a block names, or may name: then each of its lines counts as a name.
std::vector<NamedFile> named_files(std::span<const SourceFile> files, const Block& block, const Keyword& keyword);

}  // namespace prismesh::mesh::deck::radioss
