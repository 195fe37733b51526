// A folder for files that nobody keeps. Inner to cli.
#pragma once

#include <filesystem>

#include "base/error.h"

namespace prismesh::cli {

/// Its folder, with all that is in it, goes when this object does.
class TemporaryFolder {
 public:
  /// Makes a new folder where TMPDIR says, by default in /tmp. Errors: it can't be made.
  static Result<TemporaryFolder> make();
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;  ///< empty once moved from
};

}  // namespace prismesh::cli
