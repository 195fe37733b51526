// How the files of a deck are found and read, and how much of a deck is read at most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/file.h"

namespace prismesh::mesh::deck {

enum class FileKind : std::uint8_t {
  missing,
  file,
  folder,
  refused,  ///< the path leads to where nothing may be read
};

/// The only way by which the readers of decks come to files. Paths are those of the main file and of folders in its own, with the names of
/// includes behind them.
class FileAccess {
 public:
  virtual ~FileAccess() = default;
  virtual FileKind kind_of(const std::filesystem::path& path) const = 0;
  /// One name for a file, whatever links lead to it.
  virtual std::string canonical_name(const std::filesystem::path& path) const = 0;
  /// As it stands on disk. Errors: it can't be read.
  virtual Result<FileBytes> read(const std::filesystem::path& path) const = 0;
  /// Whether only a folder and what is beneath it may be read. Then absolute names of includes are refused.
  virtual bool is_confined() const = 0;
};

/// What is read of a deck at most. Beyond it the deck is refused.
struct ReadingLimits {
  std::size_t files = std::numeric_limits<std::size_t>::max();
  std::size_t text_bytes = std::numeric_limits<std::size_t>::max();  ///< of all files, unpacked
  std::size_t nodes = std::numeric_limits<std::size_t>::max();
  std::size_t elements = std::numeric_limits<std::size_t>::max();  ///< of all classes
};

}  // namespace prismesh::mesh::deck
