// Reads and writes whole files; no reader ever sees a half-written one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/progress.h"

namespace prismesh {

/// Tells whether a file on disk is still the one that was read. Where it differs the bytes may still be the same.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;
  std::int64_t modified_ns = 0;
  std::int64_t changed_ns = 0;  ///< of content, name or rights; unlike modified_ns no program can set it back
  bool operator==(const FileIdentity&) const = default;
};

/// A file's bytes in private memory: later changes or truncation of the file on disk don't reach them (a mapping would
/// raise SIGBUS). The text is followed by one NUL that isn't counted. Copies share the bytes.
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

  /// The same file with its unpacked text: `size` characters and a NUL.
  static FileBytes unpacked(FileBytes file, std::unique_ptr<char[]> text, std::size_t size);
  /// A file that another process has read. Throws std::bad_alloc.
  static FileBytes copy_of(std::string_view bytes, const FileIdentity& identity);
  /// A file that was written from these pieces. Throws std::bad_alloc.
  static FileBytes of_pieces(std::span<const std::string_view> pieces, const FileIdentity& identity);

 private:
  friend Result<FileBytes> read_file(int descriptor, const std::filesystem::path& path);
  std::shared_ptr<char[]> data_;  ///< not changed once it is filled
  std::size_t size_ = 0;
  std::shared_ptr<char[]> packed_;
  std::size_t packed_size_ = 0;
  FileIdentity identity_;
};

/// Reads a regular file. Errors: it can't be opened or read, is a folder, or changed its size while it was read.
Result<FileBytes> read_file(const std::filesystem::path& path);
/// Reads a file that is open; `path` names it in errors. Errors: as above.
Result<FileBytes> read_file(int descriptor, const std::filesystem::path& path);

Result<FileIdentity> identify_file(const std::filesystem::path& path);

/// One file of a set that is to be replaced.
struct PendingFile {
  std::filesystem::path path;
  std::vector<std::string_view> pieces;  ///< the content, in order; the memory must outlive the call
};

/// Files that are written and flushed to disk beside their targets, with the folders that name them, and wait to be put in place. The
/// destructor removes those that aren't in place, and the folders that were made for them and hold nothing.
class StagedFiles {
 public:
  struct File {
    std::filesystem::path shown;      ///< the target as the caller named it
    std::filesystem::path target;     ///< the same with links resolved
    std::filesystem::path temporary;  ///< beside the target
    FileIdentity identity;            ///< of what was written; once it is in place, of the target
  };

  /// Keeps an existing target's permissions and makes missing folders. A link is followed to a file, or to where one can be made: the
  /// folder that it leads to must exist. Reports progress at least every 8 MB, and for the last time when everything is written. Errors: a
  /// file can't be written, cancelled; then no temporary file and no new folder remains.
  static Result<StagedFiles> write(std::span<const PendingFile> files, const Progress& progress = {});

  StagedFiles() = default;
  StagedFiles(StagedFiles&& other) noexcept;
  StagedFiles& operator=(StagedFiles&& other) noexcept;
  ~StagedFiles();

  const std::vector<File>& files() const { return files_; }
  std::size_t in_place() const { return in_place_; }  ///< of the files, from the first on
  /// Refuses to replace the file with this index.
  using Check = std::function<Result<void>(std::size_t)>;
  /// Renames those that aren't in place yet, in order (so put the file that names the others last), each right after its check, and flushes
  /// the folders. After an error it may be called again and continues. Errors: of a check, a file can't be replaced, a folder can't be
  /// flushed; how many are in place.
  Result<void> put_in_place(const Check& check = {});
  /// Files that aren't in place yet stay on disk beside their targets.
  void leave();

 private:
  std::vector<File> files_;
  std::size_t in_place_ = 0;
  std::vector<std::filesystem::path> made_folders_;  ///< an outer one before those in it
};

/// Writes files beside their targets and puts them in place. On an error before the first rename nothing has changed and no temporary file
/// remains. Told to stop, it stops before the first rename or not at all. Errors: those of StagedFiles.
Result<void> replace_files(std::span<const PendingFile> files, const Progress& progress = {});

/// Flushes a folder's entries to disk. A folder that may be written but not read is flushed with its whole file system, through
/// `file_in_it`. Errors: it can't be flushed.
Result<void> flush_folder(const std::filesystem::path& folder, const std::filesystem::path& file_in_it = {});

/// Makes a folder and its missing parents, and flushes them, so that they survive a power cut. `made` gets those that it made, an outer one
/// before those in it, also after an error. Errors: one can't be made.
Result<void> make_folders(const std::filesystem::path& folder, std::vector<std::filesystem::path>* made = nullptr);

/// The folder that a file is in; "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& file);

}  // namespace prismesh
