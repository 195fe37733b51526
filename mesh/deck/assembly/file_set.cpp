#include "mesh/deck/assembly/file_set.h"

#include <algorithm>

#include "base/compression.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 20000;

fs::path normal(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return (error ? path : absolute).lexically_normal();
}

}  // namespace

std::string canonical_name(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::canonical(path, error);
  return (error ? normal(path) : canonical).string();
}

namespace {

/// Decks from Windows have backslashes between folders.
std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

std::optional<fs::path> find(const std::string& name, std::span<const fs::path> folders) {
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  for (const std::string& spelled : {name, with_slashes(name)})
    for (const fs::path& folder : folders)
      if (is_file(folder / spelled)) return folder / spelled;
  return std::nullopt;
}

/// The file that is read for this one.
const fs::path& stand_in(const StandIns& stand_ins, const fs::path& file) {
  if (stand_ins.empty()) return file;
  const auto at = stand_ins.find(canonical_name(file));
  return at == stand_ins.end() ? file : at->second;
}

/// Why no file of the name is found.
std::string why_not_found(const std::string& name, std::span<const fs::path> folders) {
  if (name.empty()) return "has no name";
  if (name.find('\0') != std::string::npos) return "has a name with a NUL byte in it";
  for (const fs::path& folder : folders) {
    std::error_code error;
    if (fs::is_directory(folder / with_slashes(name), error)) return "is a folder";
  }
  return "isn't there";
}

}  // namespace

Result<FileSet> FileSet::begin(fs::path main, const StandIns& stand_ins, const Progress& progress) {
  Result<FileBytes> bytes = read_file(stand_in(stand_ins, main));
  if (!bytes) return fail(std::move(bytes.error()));
  bytes = unpack(std::move(*bytes), main, progress);
  if (!bytes) return fail(std::move(bytes.error()));
  return FileSet(std::move(main), std::move(*bytes), stand_ins);
}

FileSet FileSet::again(FileSet files) {
  return {std::move(files.files[0].path), std::move(files.files[0].bytes), std::move(files.stand_ins_)};
}

FileSet::FileSet(fs::path main, FileBytes bytes, StandIns stand_ins)
    : stand_ins_(std::move(stand_ins)), main_folder_(normal(main).parent_path()) {
  by_canonical_[canonical_name(main)] = 0;
  if (bytes.is_packed()) unpacked_bytes_ = bytes.text().size();
  fs::path name = main.filename();
  files.push_back({std::move(main), std::move(name), std::move(bytes)});
}

/// Searches once for each pair of file and name: a deck may have many includes, and a search is slow.
std::uint32_t FileSet::include(std::uint32_t from, const std::string& name, std::span<const fs::path> folders, std::string& reason) {
  const auto [at, first] = known_.try_emplace({from, name}, kNoFile, "isn't there");
  auto& [file, why] = at->second;
  if (first && missing.size() < kMaxFiles) {
    if (const std::optional<fs::path> found = find(name, folders))
      file = open(*found, name, why);
    else
      why = why_not_found(name, folders);
  }
  if (file != kNoFile) return file;
  if (missing.size() < kMaxFiles) missing.push_back(name);
  reason = why;
  return kNoFile;
}

std::uint32_t FileSet::include_unread(std::uint32_t from, const std::string& name, std::span<const fs::path> folders,
                                      const std::string& keyword, std::string& reason) {
  const std::uint32_t file = include(from, name, folders, reason);
  const bool is_known = std::any_of(unread.begin(), unread.end(), [&](const UnreadFile& each) { return each.file == file; });
  if (file != kNoFile && file != 0 && !is_known) unread.push_back({file, keyword});
  return file;
}

bool FileSet::accompany(const std::string& name, std::span<const fs::path> folders, std::string& reason) {
  const std::optional<fs::path> found = find(name, folders);
  if (!found) {
    reason = why_not_found(name, folders);
    return false;
  }
  const std::string canonical = canonical_name(*found);
  if (companions.size() < kMaxFiles && !by_canonical_.contains(canonical) && accompanying_.insert(canonical).second)
    companions.push_back({*found, relative_name(*found, name)});
  return true;
}

/// An absolute name would still mean the old file in a copy of the deck, so it isn't made relative.
fs::path FileSet::relative_name(const fs::path& found, const std::string& name) const {
  return fs::path(name).is_absolute() ? fs::path(name) : normal(found).lexically_relative(main_folder_);
}

/// Returns the index of the file and reads it if it wasn't read before. kNoFile: it can't be read; `reason` gets why.
std::uint32_t FileSet::open(const fs::path& found, const std::string& name, std::string& reason) {
  const std::string canonical = canonical_name(found);
  if (const auto at = by_canonical_.find(canonical); at != by_canonical_.end()) return at->second;
  if (files.size() >= kMaxFiles) {
    reason = "is one of too many";
    return kNoFile;
  }
  Result<FileBytes> bytes = read_file(stand_in(stand_ins_, found));
  if (bytes) bytes = unpack(std::move(*bytes), found, {}, kMaxUnpackedBytes - std::min(unpacked_bytes_, kMaxUnpackedBytes));
  if (!bytes) {
    reason = bytes.error().message;
    return kNoFile;
  }
  if (bytes->is_packed()) unpacked_bytes_ += bytes->text().size();
  const auto index = static_cast<std::uint32_t>(files.size());
  by_canonical_[canonical] = index;
  files.push_back({found, relative_name(found, name), std::move(*bytes)});
  return index;
}

std::vector<bool> repeated_files(std::span<const FileUse* const> uses) {
  std::vector<bool> repeated(uses.size());
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t file = 0; file < uses.size(); ++file)
    if (uses[file]->uses > 1) waiting.push_back(file);
  while (!waiting.empty()) {
    const std::uint32_t file = waiting.back();
    waiting.pop_back();
    if (repeated[file]) continue;
    repeated[file] = true;
    waiting.insert(waiting.end(), uses[file]->includes.begin(), uses[file]->includes.end());
  }
  return repeated;
}

}  // namespace prismesh::mesh::deck
