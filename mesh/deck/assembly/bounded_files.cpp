#include "mesh/deck/assembly/bounded_files.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/compression.h"

namespace prismesh::mesh::deck {

Result<FileBytes> BoundedFiles::read(const std::filesystem::path& path, const std::filesystem::path& shown, const Progress& progress) {
  Result<FileBytes> bytes = read_and_unpack(path, shown, progress);
  if (bytes) count(*bytes);
  if (!bytes && bytes.error().kind == ErrorKind::over_limit && access_.is_confined() && !exceeded_) exceeded_ = bytes.error();
  return bytes;
}

Result<FileBytes> BoundedFiles::read_and_unpack(const std::filesystem::path& path, const std::filesystem::path& shown,
                                                const Progress& progress) const {
  const auto refuse = [&](const std::string& why) { return fail(Error{shown.string(), 0, why, ErrorKind::over_limit}); };
  if (files_ >= limits_.files)
    return refuse("is one file more than the " + std::to_string(limits_.files) + " that are read of a deck here");
  Result<FileBytes> bytes = access_.read(path);
  if (!bytes) return bytes;
  const std::size_t left = limits_.text_bytes - std::min(text_bytes_, limits_.text_bytes);
  if (bytes->bytes().size() > left)
    return refuse("has " + std::to_string(bytes->bytes().size()) + " bytes, and of the " + std::to_string(limits_.text_bytes) +
                  " that are read of a deck here " + std::to_string(left) + " are left");
  const std::size_t left_for_packed = kMaxUnpackedBytes - std::min(packed_files_text_, kMaxUnpackedBytes);
  Result<FileBytes> text = unpack(std::move(*bytes), shown, progress, std::min(left, left_for_packed));
  if (!text && text.error().kind == ErrorKind::over_limit && left < left_for_packed)
    return refuse("unpacks to more than the " + std::to_string(left) + " bytes that are left of the " + std::to_string(limits_.text_bytes) +
                  " that are read of a deck here");
  return text;
}

void BoundedFiles::begin_again(const FileBytes& main) {
  files_ = text_bytes_ = packed_files_text_ = 0;
  count(main);
}

void BoundedFiles::count(const FileBytes& bytes) {
  ++files_;
  text_bytes_ += bytes.text().size();
  if (bytes.is_packed()) packed_files_text_ += bytes.text().size();
}

}  // namespace prismesh::mesh::deck
