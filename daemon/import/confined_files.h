// Reads the files of a deck beneath one folder, without following links.
#pragma once

#include <optional>
#include <string>

#include "mesh/deck/data/reading.h"

namespace prismesh::importer {

class ConfinedFiles : public mesh::deck::FileAccess {
 public:
  /// `folder`: an open descriptor that outlives this. `shown`: stands for it in paths; it may be empty.
  ConfinedFiles(int folder, const std::filesystem::path& shown);

  mesh::deck::FileKind kind_of(const std::filesystem::path& path) const override;
  std::string canonical_name(const std::filesystem::path& path) const override;
  Result<FileBytes> read(const std::filesystem::path& path) const override;
  bool is_confined() const override { return true; }

 private:
  std::optional<std::string> beneath(const std::filesystem::path& path) const;
  int open(const std::filesystem::path& path, int flags) const;

  int folder_;
  std::string prefix_;  ///< of all paths beneath the folder: empty, or ending with a slash
};

}  // namespace prismesh::importer
