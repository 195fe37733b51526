// The journal's file: grows by whole records that are on disk before anyone hears of them. Private to mesh/document.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::mesh::document {

class JournalFile {
 public:
  /// Makes a file with this text, whole and on disk, where none was. Errors: it exists, can't be written.
  static Result<JournalFile> create(const std::filesystem::path& path, std::string_view text);
  /// Opens a file and reads it. Errors: not there, not readable or writable, in use by another process.
  static Result<JournalFile> open(const std::filesystem::path& path, std::string& text);

  JournalFile(JournalFile&& other) noexcept;
  JournalFile& operator=(JournalFile&& other) noexcept;
  ~JournalFile();

  const std::filesystem::path& path() const { return path_; }

  /// Appends and flushes to disk. After an error the file holds what it held before; if that can't be had, this and every
  /// later append is refused.
  Result<void> append(std::string_view text);
  /// Cuts the file off and flushes.
  Result<void> truncate(std::size_t size);
  /// Puts a text beside the file, under a new name, on disk; that name.
  Result<std::filesystem::path> keep_copy(std::string_view text) const;

 private:
  JournalFile(std::filesystem::path path, int fd, std::size_t size);
  Result<void> check_untouched() const;
  Result<void> take_back(const std::string& reason);
  Result<void> start_afresh(const std::string& reason);
  int rewrite();
  bool erase_tail();

  std::filesystem::path path_;
  int fd_ = -1;
  std::size_t size_ = 0;  ///< of what was acknowledged
  std::string broken_;    ///< why no more can be appended
};

}  // namespace prismesh::mesh::document
