// Finds models in the store by hash, read-only: for every program that may read its folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "ipc/store/folder.h"
#include "ipc/store/manifest.h"
#include "ipc/store/record.h"
#include "ipc/wire/line_fault.h"

namespace prismesh::ipc::store {

// The folders of a store and their files.
inline constexpr const char* kContentFolder = "sha256";   ///< ab/HASH: files and manifests
inline constexpr const char* kModelsFolder = "models";    ///< HASH: the record of a model
inline constexpr const char* kDamagedFolder = "damaged";  ///< HASH: an empty file; that content is known to be damaged

/// "ab", the folder of a hash below `sha256`.
std::string shard_of(const ContentHash& hash);

struct FoundModel {
  ModelRecord record;
  Manifest manifest;
};

class Reader {
 public:
  /// Errors: the folder can't be opened.
  static Result<Reader> open(const std::filesystem::path& store);

  /// Errors: there is no such model; its record or manifest is damaged.
  Result<FoundModel> find(const ContentHash& model) const;
  /// What is told of all models, the newest first; at most `limit`. Damaged records are left out. Errors: the folder can't be read.
  Result<std::vector<ModelRecord>> records(std::size_t limit) const;
  /// One file of a model, without a check of its bytes. Errors: it isn't there, is known to be damaged, or has another size.
  Result<Descriptor> open_file(const SetFile& file) const;
  /// Copies the model's files under their paths into an empty folder, and checks every byte of them. Makes files that their owner may
  /// write. Errors: a file is damaged or missing (named), `stop`; what was copied so far remains.
  Result<void> lay_out(const Manifest& manifest, const std::filesystem::path& into, const Stop& stop = {}) const;

  const std::filesystem::path& path() const { return root_.path(); }

 private:
  explicit Reader(Folder root) : root_(std::move(root)) {}
  Result<Descriptor> open_content(const ContentHash& hash) const;

  Folder root_;
};

/// SHA-256 of a whole file. Errors: it can't be read.
Result<ContentHash> hash_file(const Descriptor& file, const std::filesystem::path& shown);

}  // namespace prismesh::ipc::store
