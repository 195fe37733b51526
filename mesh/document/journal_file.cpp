#include "mesh/document/journal_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include "base/file.h"

namespace prismesh::mesh::document {

namespace {

namespace fs = std::filesystem;

std::string reason_of(int error) { return std::generic_category().message(error); }

/// 0 or an errno.
int write_all(int fd, std::string_view text, std::size_t offset) {
  while (!text.empty()) {
    const ssize_t written = ::pwrite(fd, text.data(), text.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::size_t>(written);
  }
  return 0;
}

/// 0 or an errno; EIO where the file ends early.
int read_all(int fd, std::string& text, std::size_t size) {
  text.resize(size);
  for (std::size_t done = 0; done < size;) {
    const ssize_t got = ::pread(fd, text.data() + done, size - done, static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return EIO;
    done += static_cast<std::size_t>(got);
  }
  return 0;
}

/// A new file beside `path`, written and flushed; its descriptor, or -1 and an errno.
int write_beside(const fs::path& path, std::string_view text, fs::path& made, int& error) {
  made = path;
  made += ".new-" + std::to_string(::getpid());
  const int fd = ::open(made.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (fd < 0) {
    error = errno;
    return -1;
  }
  error = write_all(fd, text, 0);
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  if (error == 0 && ::flock(fd, LOCK_EX | LOCK_NB) != 0) error = errno;
  if (error == 0) return fd;
  ::close(fd);
  ::unlink(made.c_str());
  return -1;
}

}  // namespace

JournalFile::JournalFile(fs::path path, int fd, std::size_t size) : path_(std::move(path)), fd_(fd), size_(size) {}

JournalFile::JournalFile(JournalFile&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)), size_(other.size_), broken_(std::move(other.broken_)) {}

JournalFile& JournalFile::operator=(JournalFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  std::swap(broken_, other.broken_);
  return *this;
}

JournalFile::~JournalFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<JournalFile> JournalFile::create(const fs::path& path, std::string_view text) {
  fs::path made;
  int error = 0;
  const int fd = write_beside(path, text, made, error);
  if (fd < 0) return fail(path.string(), "the journal can't be written: " + reason_of(error));
  JournalFile file(path, fd, text.size());
  // Linked instead of renamed: a link never replaces a file, so the journal appears whole or not at all.
  if (::link(made.c_str(), path.c_str()) != 0) error = errno;
  if (error == EPERM || error == EOPNOTSUPP)
    error = ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0 ? 0 : errno;
  ::unlink(made.c_str());
  if (error == EEXIST) return fail(path.string(), "there is a journal (or another file) already; recover it or choose another name");
  if (error != 0) return fail(path.string(), "the journal can't be made: " + reason_of(error));
  if (const Result<void> flushed = flush_folder(folder_of(path), path); !flushed) {
    ::unlink(path.c_str());  // nobody knows of it, so nobody would remove it
    return fail(path.string(), "the journal can't be made: " + flushed.error().text());
  }
  return file;
}

Result<JournalFile> JournalFile::open(const fs::path& path, std::string& text) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return fail(path.string(), "the journal can't be opened: " + reason_of(errno));
  JournalFile file(path, fd, 0);
  struct stat status {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) return fail(path.string(), "the journal isn't a regular file");
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0)
    return fail(path.string(),
                errno == EWOULDBLOCK ? "the journal is in use by another process" : "the journal can't be locked: " + reason_of(errno));
  if (const int error = read_all(fd, text, static_cast<std::size_t>(status.st_size)); error != 0)
    return fail(path.string(), "the journal can't be read: " + reason_of(error));
  file.size_ = text.size();
  return file;
}

Result<void> JournalFile::check_untouched() const {
  struct stat status {};
  if (::fstat(fd_, &status) != 0) return fail(path_.string(), "the journal can't be reached: " + reason_of(errno));
  if (status.st_nlink == 0) return fail(path_.string(), "the journal has been deleted; edits can't be kept any more, save the deck");
  struct stat named {};
  if (::stat(path_.c_str(), &named) != 0 || named.st_ino != status.st_ino || named.st_dev != status.st_dev)
    return fail(path_.string(), "the journal has been moved away or replaced; edits can't be kept any more, save the deck");
  if (static_cast<std::size_t>(status.st_size) != size_)
    return fail(path_.string(), "the journal has been changed by another program; edits can't be kept any more, save the deck");
  return {};
}

Result<void> JournalFile::append(std::string_view text) {
  if (!broken_.empty() && rewrite() != 0)
    return fail(path_.string(),
                "the journal takes no more edits since an earlier failure (" + broken_ + "); save the deck and open it again");
  if (Result<void> untouched = check_untouched(); !untouched) return untouched;
  if (const int error = write_all(fd_, text, size_); error != 0)
    return take_back("the edit can't be written to the journal: " + reason_of(error));
  if (::fdatasync(fd_) != 0) return start_afresh("the journal can't be flushed to disk: " + reason_of(errno));
  size_ += text.size();
  return {};
}

Result<void> JournalFile::truncate(std::size_t size) {
  if (::ftruncate(fd_, static_cast<off_t>(size)) != 0 || ::fdatasync(fd_) != 0)
    return fail(path_.string(), "the journal's incomplete last record can't be cut off: " + reason_of(errno));
  size_ = size;
  return {};
}

/// After a failed write: removes the written part of the record.
Result<void> JournalFile::take_back(const std::string& reason) {
  if (::ftruncate(fd_, static_cast<off_t>(size_)) != 0) return start_afresh(reason);
  return fail(path_.string(), reason + "; the edit wasn't made");
}

/// After a failed flush: the kernel has marked the pages clean, so this file's state on disk is unknown and another flush would prove
/// nothing. Writes the acknowledged records to a new file that replaces it.
Result<void> JournalFile::start_afresh(const std::string& reason) {
  broken_ = reason;
  if (rewrite() == 0 || erase_tail()) return fail(path_.string(), reason + "; the edit wasn't made");
  return fail(path_.string(), reason + "; nothing can be written any more, so the edit isn't made now, but may come back after a restart");
}

/// 0 or an errno.
int JournalFile::rewrite() {
  std::string kept;
  int error = read_all(fd_, kept, size_);
  if (error != 0) return error;
  fs::path made;
  const int fresh = write_beside(path_, kept, made, error);
  if (fresh < 0) return error;
  if (::rename(made.c_str(), path_.c_str()) != 0) {
    error = errno;
    ::close(fresh);
    ::unlink(made.c_str());
    return error;
  }
  ::close(std::exchange(fd_, fresh));
  if (!flush_folder(folder_of(path_), path_)) return EIO;
  broken_.clear();
  return 0;
}

/// Removes the refused record, or overwrites its bytes, so that a later reader of the file doesn't find it.
bool JournalFile::erase_tail() {
  struct stat status {};
  if (::ftruncate(fd_, static_cast<off_t>(size_)) == 0) return true;
  if (::fstat(fd_, &status) != 0) return false;
  const auto size = static_cast<std::size_t>(status.st_size);
  return size <= size_ || write_all(fd_, std::string(size - size_, '\0'), size_) == 0;
}

Result<fs::path> JournalFile::keep_copy(std::string_view text) const {
  for (int i = 1;; ++i) {
    const fs::path copy = path_.string() + ".damaged." + std::to_string(i);
    std::error_code problem;
    if (fs::exists(copy, problem)) continue;
    const PendingFile file{copy, {text}};
    if (const Result<void> written = replace_files(std::span(&file, 1)); !written) return fail(written.error());
    return copy;
  }
}

}  // namespace prismesh::mesh::document
