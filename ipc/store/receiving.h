// Receives a model's files into a folder that appears whole or not at all. What came lies beside it meanwhile, each file by its hash, and
// another call goes on with it.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "ipc/store/folder.h"
#include "ipc/store/manifest.h"
#include "ipc/wire/descriptor.h"
#include "ipc/wire/line_fault.h"

namespace prismesh::ipc::store {

/// A folder's name out of the main file's and the beginning of the model's hash.
std::string usual_folder(const Manifest& manifest, const ContentHash& model);

/// A file that is received.
struct ReceivedFile {
  Descriptor disk;
  std::filesystem::path shown;  ///< for messages
  bool is_begun = false;        ///< an earlier call may have left bytes in it
};

class Receiving {
 public:
  /// Files lie in `folder` with `ending` behind its name until all are there. Errors: `folder` is there and not empty, is a link, or ends
  /// in
  /// `.` or `..`; the one beside it can't be made; another process works there.
  static Result<Receiving> begin(std::filesystem::path folder, const std::string& ending);

  /// The file for a content, made if it is missing.
  Result<ReceivedFile> file(const ContentHash& hash) const;
  /// Puts all files under their names, compares every byte with the manifest's hashes, flushes them, and gives the folder its name. Errors:
  /// a file doesn't match (named), the disk, `stop`; then the folder isn't there, and what came stays.
  Result<void> finish(const Manifest& manifest, const Stop& stop) const;

 private:
  Receiving(std::filesystem::path folder, std::filesystem::path unfinished, Descriptor lock, Folder content)
      : folder_(std::move(folder)), unfinished_(std::move(unfinished)), lock_(std::move(lock)), content_(std::move(content)) {}

  std::filesystem::path folder_, unfinished_;
  Descriptor lock_;
  Folder content_;
};

}  // namespace prismesh::ipc::store
