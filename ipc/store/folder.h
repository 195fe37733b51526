// A folder by its descriptor. Names are single names beneath it, so that nothing is reached through links or `..`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc::store {

/// Errors of all: what the system says, with the path.
class Folder {
 public:
  /// A folder that is there.
  static Result<Folder> open(const std::filesystem::path& path);

  Result<Folder> folder(const std::string& name) const;
  /// Makes it if it is missing. Only `flush` keeps it through a power cut.
  Result<Folder> make_folder(const std::string& name, mode_t mode) const;
  bool has(const std::string& name) const;
  /// Size of a regular file. Errors: it is none.
  Result<std::uint64_t> size_of(const std::string& name) const;

  /// A regular file, never through a link.
  Result<Descriptor> read(const std::string& name) const;
  Result<Descriptor> read_and_write(const std::string& name) const;
  /// A file that wasn't there.
  Result<Descriptor> create(const std::string& name, mode_t mode = 0640) const;
  /// Makes a file with this content and flushes it.
  Result<void> write_new(const std::string& name, std::string_view content, mode_t mode = 0640) const;
  /// Puts a file with this content in the place of what has its name, by way of `temporary`, and flushes both. Errors: what has its name
  /// may be the old or the new one.
  Result<void> replace(const std::string& name, std::string_view content, const std::string& temporary, mode_t mode = 0640) const;
  /// The content of a small file. Errors: it has more than `max_bytes`.
  Result<std::string> content(const std::string& name, std::size_t max_bytes) const;

  Result<void> rename(const std::string& name, const Folder& to, const std::string& new_name) const;
  /// Another name of the same file. False: there is something with that name.
  Result<bool> link(const std::string& name, const Folder& to, const std::string& new_name) const;
  /// What isn't there counts as removed.
  Result<void> remove(const std::string& name) const;
  Result<void> flush() const;
  /// All names but "." and "..", ascending.
  Result<std::vector<std::string>> names() const;

  int descriptor() const { return descriptor_.get(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  Folder(Descriptor descriptor, std::filesystem::path path) : descriptor_(std::move(descriptor)), path_(std::move(path)) {}
  Result<Descriptor> open_file(const std::string& name, int flags) const;

  Descriptor descriptor_;
  std::filesystem::path path_;  ///< for messages
};

/// Writes all of it at the offset. Errors: what the system says; the disk is full is told so.
Result<void> write_at(const Descriptor& file, std::string_view bytes, std::uint64_t offset, const std::filesystem::path& shown);
/// Reads up to `size` bytes. Fewer: the file ends there.
Result<std::size_t> read_at(const Descriptor& file, char* bytes, std::size_t size, std::uint64_t offset,
                            const std::filesystem::path& shown);
Result<void> flush_file(const Descriptor& file, const std::filesystem::path& shown);

/// Whether the text can be a name in a Folder: no slash, not empty, not "." or "..".
bool is_single_name(std::string_view name);

}  // namespace prismesh::ipc::store
