// Finds and reads the files of a deck by their paths, wherever they are.
#pragma once

#include "mesh/deck/data/reading.h"

namespace prismesh::mesh::deck {

class FilesOnDisk : public FileAccess {
 public:
  FileKind kind_of(const std::filesystem::path& path) const override;
  std::string canonical_name(const std::filesystem::path& path) const override;
  Result<FileBytes> read(const std::filesystem::path& path) const override;
  bool is_confined() const override { return false; }
};

}  // namespace prismesh::mesh::deck
