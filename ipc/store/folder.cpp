#include "ipc/store/folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace prismesh::ipc::store {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFirstRead = std::size_t{1} << 16;

std::string system_reason(int code) {
  if (code == ENOSPC || code == EDQUOT) return "the disk is full (" + std::generic_category().message(code) + ")";
  return std::generic_category().message(code);
}

tl::unexpected<Error> system_failure(const fs::path& path, const std::string& what, int code) {
  return fail(path.string(), what + ": " + system_reason(code));
}

/// A single name can't lead out of the folder but as a link. openat2 would say the same, but systemd takes it from units that may not make
/// files of others (RestrictSUIDSGID).
int open_beneath(int folder, const std::string& name, int flags) {
  if (!is_single_name(name)) {
    errno = EXDEV;
    return -1;
  }
  return ::openat(folder, name.c_str(), flags | O_NOFOLLOW | O_CLOEXEC);
}

}  // namespace

bool is_single_name(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

Result<Folder> Folder::open(const fs::path& path) {
  Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder) return system_failure(path, "the folder can't be opened", errno);
  return Folder(std::move(folder), path);
}

Result<Folder> Folder::folder(const std::string& name) const {
  Descriptor inner(open_beneath(descriptor_.get(), name, O_RDONLY | O_DIRECTORY));
  if (!inner) return system_failure(path_ / name, "the folder can't be opened", errno);
  return Folder(std::move(inner), path_ / name);
}

Result<Folder> Folder::make_folder(const std::string& name, mode_t mode) const {
  if (::mkdirat(descriptor_.get(), name.c_str(), mode) != 0 && errno != EEXIST)
    return system_failure(path_ / name, "the folder can't be made", errno);
  return folder(name);
}

bool Folder::has(const std::string& name) const {
  struct stat status {};
  return ::fstatat(descriptor_.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

Result<std::uint64_t> Folder::size_of(const std::string& name) const {
  struct stat status {};
  if (::fstatat(descriptor_.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0)
    return system_failure(path_ / name, "can't be found", errno);
  if (!S_ISREG(status.st_mode)) return fail((path_ / name).string(), "is not a regular file");
  return static_cast<std::uint64_t>(status.st_size);
}

Result<Descriptor> Folder::open_file(const std::string& name, int flags) const {
  // O_NONBLOCK: opening a pipe that nobody writes to must not hang.
  Descriptor file(open_beneath(descriptor_.get(), name, flags | O_NONBLOCK));
  if (!file) return system_failure(path_ / name, "can't be opened", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return fail((path_ / name).string(), "is not a regular file");
  return file;
}

Result<Descriptor> Folder::read(const std::string& name) const { return open_file(name, O_RDONLY); }
Result<Descriptor> Folder::read_and_write(const std::string& name) const { return open_file(name, O_RDWR); }

Result<Descriptor> Folder::create(const std::string& name, mode_t mode) const {
  Descriptor file(::openat(descriptor_.get(), name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
  if (!file) return system_failure(path_ / name, "can't be made", errno);
  return file;
}

Result<void> Folder::write_new(const std::string& name, std::string_view content, mode_t mode) const {
  const Result<Descriptor> file = create(name, mode);
  if (!file) return fail(file.error());
  Result<void> written = write_at(*file, content, 0, path_ / name);
  if (written) written = flush_file(*file, path_ / name);
  if (!written) (void)remove(name);
  return written;
}

Result<void> Folder::replace(const std::string& name, std::string_view content, const std::string& temporary, mode_t mode) const {
  if (const Result<void> written = write_new(temporary, content, mode); !written) return written;
  Result<void> put = rename(temporary, *this, name);
  if (!put) (void)remove(temporary);
  if (put) put = flush();
  return put;
}

Result<std::string> Folder::content(const std::string& name, std::size_t max_bytes) const {
  const Result<Descriptor> file = read(name);
  if (!file) return fail(file.error());
  // Memory for what is there: the limit may be more than the machine has.
  std::string text;
  for (;;) {
    const std::size_t had = text.size();
    const std::size_t wanted = std::min(std::max(had, kFirstRead), max_bytes - had) + 1;
    text.resize(had + wanted);
    const Result<std::size_t> got = read_at(*file, text.data() + had, wanted, had, path_ / name);
    if (!got) return fail(got.error());
    text.resize(had + *got);
    if (text.size() > max_bytes) return fail((path_ / name).string(), "is longer than " + std::to_string(max_bytes) + " bytes");
    if (*got < wanted) return text;
  }
}

Result<void> Folder::rename(const std::string& name, const Folder& to, const std::string& new_name) const {
  if (::renameat2(descriptor_.get(), name.c_str(), to.descriptor_.get(), new_name.c_str(), 0) != 0)
    return system_failure(to.path_ / new_name, "can't be put in place", errno);
  return {};
}

Result<bool> Folder::link(const std::string& name, const Folder& to, const std::string& new_name) const {
  if (::linkat(descriptor_.get(), name.c_str(), to.descriptor_.get(), new_name.c_str(), 0) == 0) return true;
  if (errno == EEXIST) return false;
  return system_failure(to.path_ / new_name, "can't be put in place", errno);
}

Result<void> Folder::remove(const std::string& name) const {
  if (::unlinkat(descriptor_.get(), name.c_str(), 0) != 0 && errno != ENOENT)
    return system_failure(path_ / name, "can't be removed", errno);
  return {};
}

Result<void> Folder::flush() const {
  // Some file systems have no way to flush a folder, and say EINVAL.
  if (::fsync(descriptor_.get()) != 0 && errno != EINVAL) return system_failure(path_, "can't be flushed to disk", errno);
  return {};
}

Result<std::vector<std::string>> Folder::names() const {
  const int again = ::openat(descriptor_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (again < 0) return system_failure(path_, "the folder can't be read", errno);
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::fdopendir(again), ::closedir);
  if (!listing) return system_failure(path_, "the folder can't be read", errno);
  std::vector<std::string> names;
  for (;;) {
    errno = 0;
    const dirent* entry = ::readdir(listing.get());  // NOLINT(concurrency-mt-unsafe): a stream of this thread
    if (entry == nullptr && errno != 0) return system_failure(path_, "the folder can't be read", errno);
    if (entry == nullptr) break;
    if (is_single_name(entry->d_name)) names.emplace_back(entry->d_name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Result<void> write_at(const Descriptor& file, std::string_view bytes, std::uint64_t offset, const fs::path& shown) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::pwrite(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return system_failure(shown, "can't be written", wrote < 0 ? errno : EIO);
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
    offset += static_cast<std::uint64_t>(wrote);
  }
  return {};
}

Result<std::size_t> read_at(const Descriptor& file, char* bytes, std::size_t size, std::uint64_t offset, const fs::path& shown) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(file.get(), bytes + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_failure(shown, "can't be read", errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

Result<void> flush_file(const Descriptor& file, const fs::path& shown) {
  if (::fsync(file.get()) != 0) return system_failure(shown, "can't be flushed to disk", errno);
  return {};
}

}  // namespace prismesh::ipc::store
