// Puts the files of a model into a vault: the pieces that it misses, then what names them, and the manifest last.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "ipc/store/local_files.h"
#include "ipc/store/record.h"
#include "ipc/vault/vault.h"

namespace prismesh::ipc::vault {

struct VaultPushOptions {
  std::string name;        ///< for people; empty: the one that the model has there, else that of the main file
  std::int64_t now_s = 0;  ///< since 1970
  bool sends_all = false;  ///< also what the vault has
  Progress progress;
};

struct VaultPushed {
  store::ModelRecord model;
  bool was_there = false;  ///< the vault had the model already, and nothing was sent
  std::uint64_t pieces = 0;
  std::uint64_t sent_pieces = 0;
  std::uint64_t sent_bytes = 0;  ///< of pieces
};

/// `main`: the path of the main file, one of `files`. When it fails the model isn't there; called again, it sends what is missing. Errors:
/// a file can't be read, or changed meanwhile; a path or name that a model can't have; the line stays cut; the store refuses.
Result<VaultPushed> push(Vault& vault, const std::vector<store::LocalFile>& files, const std::string& main,
                         const VaultPushOptions& options);

}  // namespace prismesh::ipc::vault
