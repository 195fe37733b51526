#include "mesh/deck/assembly/files_on_disk.h"

#include <system_error>

#include "mesh/deck/assembly/file_set.h"

namespace prismesh::mesh::deck {

FileKind FilesOnDisk::kind_of(const std::filesystem::path& path) const {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return FileKind::folder;
  return std::filesystem::exists(path, error) ? FileKind::file : FileKind::missing;
}

std::string FilesOnDisk::canonical_name(const std::filesystem::path& path) const { return deck::canonical_name(path); }

Result<FileBytes> FilesOnDisk::read(const std::filesystem::path& path) const { return read_file(path); }

}  // namespace prismesh::mesh::deck
