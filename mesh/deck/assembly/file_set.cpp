#include "mesh/deck/assembly/file_set.h"

#include <algorithm>

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

/// The file that is read for this one.
const fs::path& stand_in(const StandIns& stand_ins, const fs::path& file, const FileAccess& access) {
  if (stand_ins.empty()) return file;
  const auto at = stand_ins.find(access.canonical_name(file));
  return at == stand_ins.end() ? file : at->second;
}

}  // namespace

Result<FileSet> FileSet::begin(fs::path main, BoundedFiles& reading, const StandIns& stand_ins, const Progress& progress) {
  Result<FileBytes> bytes = reading.read(stand_in(stand_ins, main, reading.access()), main, progress);
  if (!bytes) return fail(std::move(bytes.error()));
  return FileSet(std::move(main), std::move(*bytes), reading, stand_ins);
}

FileSet FileSet::again(FileSet files) {
  files.reading_->begin_again(files.files[0].bytes);
  return {std::move(files.files[0].path), std::move(files.files[0].bytes), *files.reading_, std::move(files.stand_ins_)};
}

FileSet::FileSet(fs::path main, FileBytes bytes, BoundedFiles& reading, StandIns stand_ins)
    : reading_(&reading), stand_ins_(std::move(stand_ins)), main_folder_(normal(main).parent_path()) {
  by_canonical_[reading.access().canonical_name(main)] = 0;
  fs::path name = main.filename();
  files.push_back({std::move(main), std::move(name), std::move(bytes)});
}

/// Nothing, and `reason`: no file of the name is found, or none may be read.
std::optional<fs::path> FileSet::find(const std::string& name, std::span<const fs::path> folders, std::string& reason) const {
  reason = "isn't there";
  if (name.empty()) reason = "has no name";
  if (name.find('\0') != std::string::npos) reason = "has a name with a NUL byte in it";
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  const FileAccess& access = reading_->access();
  if (access.is_confined() && (fs::path(name).is_absolute() || fs::path(with_slashes(name)).is_absolute())) {
    reason = "has an absolute name; of this deck only files beside its main file and beneath are read";
    return std::nullopt;
  }
  for (const std::string& spelled : {name, with_slashes(name)})
    for (const fs::path& folder : folders) {
      const FileKind kind = access.kind_of(folder / spelled);
      if (kind == FileKind::file) return folder / spelled;
      if (kind == FileKind::folder) reason = "is a folder";
      if (kind == FileKind::refused) reason = "leads out of the deck's folder, or through a link; such files of this deck aren't read";
    }
  return std::nullopt;
}

/// Searches once for each pair of file and name: a deck may have many includes, and a search is slow.
std::uint32_t FileSet::include(std::uint32_t from, const std::string& name, std::span<const fs::path> folders, std::string& reason) {
  const auto [at, first] = known_.try_emplace({from, name}, kNoFile, "isn't there");
  auto& [file, why] = at->second;
  if (first && missing.size() < kMaxFiles) {
    if (const std::optional<fs::path> found = find(name, folders, why)) file = open(*found, name, why);
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
  const std::optional<fs::path> found = find(name, folders, reason);
  if (!found) return false;
  const std::string canonical = reading_->access().canonical_name(*found);
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
  const std::string canonical = reading_->access().canonical_name(found);
  if (const auto at = by_canonical_.find(canonical); at != by_canonical_.end()) return at->second;
  if (files.size() >= kMaxFiles) {
    reason = "is one of too many";
    return kNoFile;
  }
  Result<FileBytes> bytes = reading_->read(stand_in(stand_ins_, found, reading_->access()), found);
  if (!bytes) {
    reason = bytes.error().message;
    return kNoFile;
  }
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
