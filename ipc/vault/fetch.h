// Fetches a model from a vault: each piece is hashed before it is used, and the folder appears whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "ipc/store/manifest.h"
#include "ipc/store/record.h"
#include "ipc/vault/vault.h"

namespace prismesh::ipc::vault {

/// The model that is meant, by store::choose_model; one by its whole hash also where a list doesn't have it (yet). Errors: there is none,
/// or several.
Result<store::ModelRecord> find_model(Vault& vault, const std::string& wanted);

/// Errors: it isn't there; it has another hash; it isn't taken (store::decode_manifest).
Result<store::Manifest> get_manifest(Vault& vault, const store::ContentHash& model);

/// The pieces of a file in order. Errors: their list isn't there, or can't be one of this file.
Result<std::vector<store::ContentHash>> get_pieces(Vault& vault, const store::SetFile& file);

struct VaultFetchOptions {
  std::optional<std::filesystem::path> folder;  ///< nothing: a new one in the current folder, named by main file and hash
  Progress progress;
};

struct VaultFetched {
  store::ModelRecord model;
  std::filesystem::path folder;
  std::filesystem::path main;        ///< the main file, in the folder
  std::uint64_t received_bytes = 0;  ///< of pieces
};

/// Errors: as find_model; the folder is there and not empty; an object is missing or has other bytes than its name says; the line stays
/// cut: then what came lies beside the folder, and another call goes on with it.
Result<VaultFetched> fetch(Vault& vault, const std::string& wanted, const VaultFetchOptions& options);

/// What doesn't match in a vault.
struct VaultFault {
  store::ContentHash model;
  std::string file;    ///< a path in the model; empty: the model itself
  std::string object;  ///< empty: all objects are as they were put, but don't make up the file
  std::string fault;   ///< a sentence without its subject
};

struct Verified {
  std::uint64_t models = 0;
  std::uint64_t objects = 0;  ///< that were read, and bytes in them
  std::uint64_t bytes = 0;
  std::vector<VaultFault> faults;
};

/// Reads all objects of the model that is meant, or of all, and compares them with their hashes. Errors: as find_model; the line stays cut;
/// the store refuses.
Result<Verified> verify(Vault& vault, const std::optional<std::string>& wanted, const Progress& progress);

}  // namespace prismesh::ipc::vault
