#include "daemon/import/confined_files.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "ipc/wire/descriptor.h"

namespace prismesh::importer {

namespace {

using mesh::deck::FileKind;

constexpr const char* kRefused = "leads out of the deck's folder, or through a link; such files of this deck aren't read";

/// Whether openat2 has refused the path for where it leads.
bool leads_elsewhere(int code) { return code == EXDEV || code == ELOOP; }

}  // namespace

ConfinedFiles::ConfinedFiles(int folder, const std::filesystem::path& shown) : folder_(folder), prefix_(shown.string()) {
  if (!prefix_.empty() && !prefix_.ends_with('/')) prefix_ += '/';
}

/// The path relative to the folder, which openat2 checks. Nothing: it begins elsewhere.
std::optional<std::string> ConfinedFiles::beneath(const std::filesystem::path& path) const {
  const std::string text = path.string();
  if (!text.starts_with(prefix_) || (prefix_.empty() && path.is_absolute())) return std::nullopt;
  return text.substr(prefix_.size());
}

/// A descriptor, or -1 and errno.
int ConfinedFiles::open(const std::filesystem::path& path, int flags) const {
  const std::optional<std::string> relative = beneath(path);
  if (!relative) {
    errno = EXDEV;
    return -1;
  }
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags | O_CLOEXEC);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  return static_cast<int>(::syscall(SYS_openat2, folder_, relative->c_str(), &how, sizeof how));
}

FileKind ConfinedFiles::kind_of(const std::filesystem::path& path) const {
  const ipc::Descriptor found(open(path, O_PATH));
  if (!found) return leads_elsewhere(errno) ? FileKind::refused : FileKind::missing;
  struct stat status {};
  if (::fstat(found.get(), &status) != 0) return FileKind::refused;
  return S_ISDIR(status.st_mode) ? FileKind::folder : FileKind::file;
}

/// There are no links on the way, so two spellings of a path differ in dots and slashes at most.
std::string ConfinedFiles::canonical_name(const std::filesystem::path& path) const { return path.lexically_normal().string(); }

Result<FileBytes> ConfinedFiles::read(const std::filesystem::path& path) const {
  // O_NONBLOCK: opening a pipe that nobody writes to must not hang.
  const ipc::Descriptor file(open(path, O_RDONLY | O_NONBLOCK));
  if (!file && leads_elsewhere(errno)) return fail(path.string(), kRefused);
  if (!file) return fail(path.string(), std::string("can't be opened: ") + std::strerror(errno));
  return read_file(file.get(), path);
}

}  // namespace prismesh::importer
