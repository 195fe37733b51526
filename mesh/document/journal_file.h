// The journal's file: it grows by whole records, which are on disk when `append` returns. Private to mesh/document.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::mesh::document {

class JournalFile {
 public:
  /// Makes a new file with this text, flushed to disk. Errors: it exists, can't be written.
  static Result<JournalFile> create(const std::filesystem::path& path, std::string_view text);
  /// Opens a file and reads it. Errors: not there, not readable or writable, in use by another process.
  static Result<JournalFile> open(const std::filesystem::path& path, std::string& text);

  JournalFile(JournalFile&& other) noexcept;
  JournalFile& operator=(JournalFile&& other) noexcept;
  ~JournalFile();

  const std::filesystem::path& path() const { return path_; }

  /// Errors: the file was deleted, moved away, replaced, or has another length than this has written or read.
  Result<void> check_untouched() const;
  /// Appends and flushes to disk. After an error the file holds what it held before; if it can't be restored, this and every later append
  /// fails.
  Result<void> append(std::string_view text);
  /// Cuts the file off and flushes.
  Result<void> truncate(std::size_t size);
  /// Writes a text to a new file beside this one, flushed to disk; returns its name.
  Result<std::filesystem::path> keep_copy(std::string_view text) const;

 private:
  JournalFile(std::filesystem::path path, int fd, std::size_t size);
  Result<void> take_back(const std::string& reason);
  Result<void> start_afresh(const std::string& reason);
  int rewrite();
  bool erase_tail();

  std::filesystem::path path_;
  int fd_ = -1;
  std::size_t size_ = 0;  ///< of the acknowledged records
  std::string broken_;    ///< why nothing can be appended any more
};

}  // namespace prismesh::mesh::document
