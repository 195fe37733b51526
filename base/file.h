// Reading and writing whole files so that nothing half-written is ever seen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/progress.h"

namespace prismesh {

/// What tells whether a file on disk is still the one that was read.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;
  std::int64_t modified_ns = 0;
  bool operator==(const FileIdentity&) const = default;
};

/// A file's bytes in private memory: later changes or truncation of the file on disk don't reach them (a mapping would
/// raise SIGBUS). The text is followed by one NUL that isn't counted.
class FileBytes {
 public:
  /// What the file says: its bytes, or what they unpack to (base/compression.h).
  std::string_view text() const { return {data_.get(), size_}; }
  /// As they stand on disk.
  std::span<const std::byte> bytes() const {
    return packed_ ? std::as_bytes(std::span(packed_.get(), packed_size_)) : std::as_bytes(std::span(data_.get(), size_));
  }
  bool is_packed() const { return packed_ != nullptr; }
  const FileIdentity& identity() const { return identity_; }

  /// A file whose bytes unpack to `text`, of `size` characters and a NUL.
  static FileBytes unpacked(FileBytes file, std::unique_ptr<char[]> text, std::size_t size);

 private:
  friend Result<FileBytes> read_file(const std::filesystem::path& path);
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
  std::unique_ptr<char[]> packed_;
  std::size_t packed_size_ = 0;
  FileIdentity identity_;
};

/// Reads a regular file. Errors: it can't be opened or read, is a folder, or changed its size while it was read.
Result<FileBytes> read_file(const std::filesystem::path& path);

Result<FileIdentity> identify_file(const std::filesystem::path& path);

/// One file of a set that is to be replaced.
struct PendingFile {
  std::filesystem::path path;
  std::vector<std::string_view> pieces;  ///< the content, in order; the memory must outlive the call
};

/// Writes every file beside its target, flushes them to disk, then renames them into place in the given order (so put
/// the file that names the others last) and flushes the folders. An existing target keeps its permissions; folders that
/// lack are made. On an error before the first rename nothing has changed and no temporary file remains. The progress is told each 8 MB
/// or less, and for the last time right before the first rename: from then on nothing stops it. Errors: a file can't be written or
/// replaced, cancelled.
Result<void> replace_files(std::span<const PendingFile> files, const Progress& progress = {});

}  // namespace prismesh
