// Reads and unpacks the files of a deck up to its limits.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "base/progress.h"
#include "mesh/deck/data/reading.h"

namespace prismesh::mesh::deck {

/// Counts what it has read. An include that can't be read is only warned of; a limit that is exceeded refuses the deck, so it is
/// remembered.
class BoundedFiles {
 public:
  BoundedFiles(const FileAccess& access, const ReadingLimits& limits) : access_(access), limits_(limits) {}

  const FileAccess& access() const { return access_; }
  /// Reads a file and unpacks it. `shown` names it in errors, where it stands in for another. Errors: it can't be read or unpacked, a limit
  /// is exceeded (ErrorKind::over_limit), cancelled.
  Result<FileBytes> read(const std::filesystem::path& path, const std::filesystem::path& shown, const Progress& progress = {});
  /// Forgets all files that were counted but the main one.
  void begin_again(const FileBytes& main);
  /// The first limit that was exceeded. Only where the access is confined: a user's own deck is read as far as it can be.
  const std::optional<Error>& exceeded() const { return exceeded_; }

 private:
  Result<FileBytes> read_and_unpack(const std::filesystem::path& path, const std::filesystem::path& shown, const Progress& progress) const;
  void count(const FileBytes& bytes);

  const FileAccess& access_;
  ReadingLimits limits_;
  std::size_t files_ = 0;
  std::size_t text_bytes_ = 0;
  std::size_t packed_files_text_ = 0;  ///< the text of all packed files
  std::optional<Error> exceeded_;
};

}  // namespace prismesh::mesh::deck
