#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "base/large_memory.h"
#include "base/parallel_for.h"

namespace prismesh {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadPiece = std::size_t{8} << 20;
constexpr std::size_t kWritePiece = std::size_t{8} << 20;
constexpr int kLinkDepth = 40;  // as many links in a row as the kernel follows

std::string reason(int error) { return std::generic_category().message(error); }

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  /// Closes now: some file systems report a failed write only here. 0 or an errno.
  int close() {
    const int fd = std::exchange(fd_, -1);
    return ::close(fd) == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

std::int64_t nanoseconds(const timespec& time) { return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec; }

FileIdentity identity_of(const struct stat& status) {
  return {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino), static_cast<std::uint64_t>(status.st_size),
          nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)};
}

/// Whether two identities differ at most by what a rename changes.
bool is_same_but_for_name(FileIdentity a, const FileIdentity& b) {
  a.changed_ns = b.changed_ns;
  return a == b;
}

/// Fills [data, data + size) from `offset` on. 0, an errno, or -1 where the file ended early.
int read_range(int fd, char* data, std::size_t size, std::size_t offset) {
  while (size > 0) {
    const ssize_t got = ::pread(fd, data, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return -1;
    data += got;
    offset += static_cast<std::size_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return 0;
}

}  // namespace

FileBytes FileBytes::unpacked(FileBytes file, std::unique_ptr<char[]> text, std::size_t size) {
  file.packed_ = std::exchange(file.data_, std::shared_ptr<char[]>(std::move(text)));
  file.packed_size_ = std::exchange(file.size_, size);
  return file;
}

FileBytes FileBytes::copy_of(std::string_view bytes, const FileIdentity& identity) {
  FileBytes file;
  file.size_ = bytes.size();
  file.data_.reset(new char[bytes.size() + 1]);
  if (!bytes.empty()) std::memcpy(file.data_.get(), bytes.data(), bytes.size());
  file.data_[bytes.size()] = '\0';
  file.identity_ = identity;
  return file;
}

FileBytes FileBytes::of_pieces(std::span<const std::string_view> pieces, const FileIdentity& identity) {
  std::vector<std::size_t> begins{0};
  for (const std::string_view piece : pieces) begins.push_back(begins.back() + piece.size());
  FileBytes file;
  file.size_ = begins.back();
  file.data_.reset(new char[file.size_ + 1]);
  prefer_large_pages(file.data_.get(), file.size_);
  parallel_for(file.size_, kReadPiece, [&](std::size_t begin, std::size_t end) {
    std::size_t p = static_cast<std::size_t>(std::upper_bound(begins.begin(), begins.end(), begin) - begins.begin()) - 1;
    while (begin < end) {
      const std::string_view part = pieces[p].substr(begin - begins[p], end - begin);
      if (!part.empty()) std::memcpy(file.data_.get() + begin, part.data(), part.size());
      begin += part.size();
      ++p;
    }
  });
  file.data_[file.size_] = '\0';
  file.identity_ = identity;
  return file;
}

Result<FileIdentity> identify_file(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return fail(path.string(), "can't be found: " + reason(errno));
  return identity_of(status);
}

Result<FileBytes> read_file(const fs::path& path) {
  // O_NONBLOCK: opening a pipe that nobody writes to must not hang.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) return fail(path.string(), "can't be opened: " + reason(errno));
  return read_file(file.get(), path);
}

Result<FileBytes> read_file(int descriptor, const fs::path& path) {
  struct stat before {};
  if (::fstat(descriptor, &before) != 0) return fail(path.string(), "can't be read: " + reason(errno));
  if (S_ISDIR(before.st_mode)) return fail(path.string(), "is a folder, not a file");
  if (!S_ISREG(before.st_mode)) return fail(path.string(), "is not a regular file");

  FileBytes bytes;
  bytes.size_ = static_cast<std::size_t>(before.st_size);
  bytes.data_.reset(new (std::nothrow) char[bytes.size_ + 1]);
  if (!bytes.data_) return fail(path.string(), "is too large for this machine's memory (" + std::to_string(bytes.size_) + " bytes)");
  prefer_large_pages(bytes.data_.get(), bytes.size_);
  bytes.data_[bytes.size_] = '\0';
  std::atomic<int> error = 0;
  parallel_for(bytes.size_, kReadPiece, [&](std::size_t begin, std::size_t end) {
    if (const int failed = read_range(descriptor, bytes.data_.get() + begin, end - begin, begin); failed != 0) error = failed;
  });
  if (error > 0) return fail(path.string(), "can't be read: " + reason(error));
  struct stat after {};
  if (::fstat(descriptor, &after) != 0) return fail(path.string(), "can't be read: " + reason(errno));
  // Another program may link or replace the file meanwhile: its bytes stay. Where they changed, the identity of before tells later.
  if (error != 0 || !is_same_but_for_name(identity_of(before), identity_of(after)))
    return fail(path.string(), "changed while it was being read; open it again");
  bytes.identity_ = identity_of(before);
  return bytes;
}

namespace {

/// The file that `path` leads to through symbolic links. Writing to it keeps the link.
Result<fs::path> follow_links(const fs::path& path) {
  fs::path target = path;
  for (int links = 0; links <= kLinkDepth; ++links) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
    const fs::path next = fs::read_symlink(target, error);
    if (error) return fail(path.string(), "can't follow the symbolic link: " + error.message());
    target = target.parent_path() / next;  // which is `next` where that is absolute
  }
  return fail(path.string(), "can't follow the symbolic link: too many links in a row");
}

/// One file while it is staged: removed when it goes out of scope before it is finished.
struct Staging {
  StagedFiles::File file;

  Staging() = default;
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  ~Staging() {
    if (!file.temporary.empty()) ::unlink(file.temporary.c_str());
  }
};

/// Counts the bytes written of all files.
class Written {
 public:
  Written(std::span<const PendingFile> files, const Progress& progress) : progress_(progress) {
    for (const PendingFile& file : files)
      for (const std::string_view piece : file.pieces) all_ += piece.size();
  }
  void add(std::size_t bytes) { written_ += bytes; }
  /// Reports the progress. False: stop.
  bool goes_on() const { return !progress_ || progress_(all_ == 0 ? 1.0 : static_cast<double>(written_) / static_cast<double>(all_)); }

 private:
  const Progress& progress_;
  std::size_t all_ = 0;
  std::size_t written_ = 0;
};

constexpr int kStopped = -1;

/// 0 or an errno.
int write_batch(int fd, std::vector<iovec>& batch) {
  std::size_t first = 0;
  while (first < batch.size()) {
    const ssize_t wrote = ::writev(fd, batch.data() + first, static_cast<int>(batch.size() - first));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return errno;
    if (wrote == 0) return EIO;
    // A short write goes on where it stopped; the reason for it shows as an error then.
    auto left = static_cast<std::size_t>(wrote);
    while (first < batch.size() && left >= batch[first].iov_len) left -= batch[first++].iov_len;
    if (left > 0) {
      batch[first].iov_base = static_cast<char*>(batch[first].iov_base) + left;
      batch[first].iov_len -= left;
    }
  }
  return 0;
}

/// 0, an errno or kStopped.
int write_pieces(int fd, const std::vector<std::string_view>& pieces, Written& written) {
  std::vector<iovec> batch;
  std::size_t next = 0;
  std::size_t offset = 0;  // in the next piece
  while (next < pieces.size()) {
    batch.clear();
    std::size_t bytes = 0;
    while (next < pieces.size() && batch.size() < IOV_MAX && bytes < kWritePiece) {
      const std::string_view part = pieces[next].substr(offset, kWritePiece - bytes);
      if (!part.empty()) batch.push_back({const_cast<char*>(part.data()), part.size()});
      bytes += part.size();
      offset += part.size();
      if (offset < pieces[next].size()) continue;
      ++next;
      offset = 0;
    }
    if (const int error = write_batch(fd, batch); error != 0) return error;
    written.add(bytes);
    if (!written.goes_on()) return kStopped;
  }
  return 0;
}

tl::unexpected<Error> write_failure(const fs::path& path, int error) {
  if (error == ENOSPC || error == EDQUOT)
    return fail(path.string(), "can't be written: the disk is full (" + reason(error) + "); nothing was changed");
  return fail(path.string(), "can't be written: " + reason(error) + "; nothing was changed");
}

/// The permissions the new file gets: those of the target it replaces.
Result<void> take_permissions(int fd, const StagedFiles::File& staged) {
  struct stat old {};
  if (::stat(staged.target.c_str(), &old) != 0) {
    if (errno == ENOENT) return {};
    return write_failure(staged.shown, errno);
  }
  if (S_ISDIR(old.st_mode)) return fail(staged.shown.string(), "is a folder; a file can't take its place");
  if (!S_ISREG(old.st_mode)) return fail(staged.shown.string(), "is not a regular file; it isn't replaced");
  // Renaming over a file needs no right to write it, so whoever marked it read-only must be respected here; root as well.
  if ((old.st_mode & 0222) == 0 || ::faccessat(AT_FDCWD, staged.target.c_str(), W_OK, AT_EACCESS) != 0)
    return fail(staged.shown.string(), "is read-only; nothing was changed");
  // Only root may give a file away; keeping the group is worth a try, failing to isn't worth refusing for.
  if (::fchown(fd, old.st_uid, old.st_gid) != 0 && ::fchown(fd, static_cast<uid_t>(-1), old.st_gid) != 0) errno = 0;
  if (::fchmod(fd, old.st_mode & 07777) != 0) return write_failure(staged.shown, errno);
  return {};
}

Result<StagedFiles::File> stage(const PendingFile& file, Written& written, std::vector<fs::path>& made_folders) {
  Staging staging;
  StagedFiles::File& staged = staging.file;
  staged.shown = file.path;
  Result<fs::path> target = follow_links(file.path);
  if (!target) return fail(target.error());
  staged.target = *target;
  std::error_code missing;
  if (staged.target != file.path && !fs::is_directory(folder_of(staged.target), missing))
    return fail(file.path.string(), "is a symbolic link to " + staged.target.string() + ", whose folder isn't there; nothing was written");
  if (const Result<void> made = make_folders(folder_of(staged.target), &made_folders); !made)
    return fail(file.path.string(), "its folder can't be made: " + made.error().text());

  std::string name = (folder_of(staged.target) / ("." + staged.target.filename().string() + ".XXXXXX")).string();
  Descriptor fd(::mkostemp(name.data(), O_CLOEXEC));
  if (fd.get() < 0) {
    const int refused = errno;
    if (refused == EACCES || refused == EROFS || refused == EPERM)
      return fail(file.path.string(),
                  "can't be written: the folder " + folder_of(staged.target).string() + " is read-only (" + reason(refused) + ")");
    return write_failure(file.path, refused);
  }
  staged.temporary = name;
  // mkstemp makes private files; a new deck is as readable as any file its user makes.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  if (::fchmod(fd.get(), 0666 & ~mask) != 0) return write_failure(file.path, errno);
  if (Result<void> taken = take_permissions(fd.get(), staged); !taken) return fail(taken.error());
  const int error = write_pieces(fd.get(), file.pieces, written);
  if (error == kStopped) return fail(cancelled());
  if (error != 0) return write_failure(file.path, error);
  if (::fsync(fd.get()) != 0) return write_failure(file.path, errno);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return write_failure(file.path, errno);
  staged.identity = identity_of(status);
  if (const int closed = fd.close(); closed != 0) return write_failure(file.path, closed);
  return std::exchange(staging.file, {});
}

}  // namespace

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

Result<void> flush_folder(const fs::path& folder, const fs::path& file_in_it) {
  const auto failed = [&](int error) { return fail(folder.string(), "can't be flushed to disk: " + reason(error)); };
  const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0 && errno == EACCES && !file_in_it.empty()) {
    const Descriptor file(::open(file_in_it.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0 || ::syncfs(file.get()) != 0) return failed(errno);
    return {};
  }
  if (fd.get() < 0) return failed(errno);
  // Some file systems have no way to flush a folder, and say EINVAL.
  if (::fsync(fd.get()) != 0 && errno != EINVAL) return failed(errno);
  return {};
}

Result<void> make_folders(const fs::path& folder, std::vector<fs::path>* made) {
  std::error_code problem;
  if (folder.empty() || fs::is_directory(folder, problem)) return {};
  const fs::path above = folder_of(folder.has_filename() ? folder : folder.parent_path());
  if (Result<void> made_above = make_folders(above, made); !made_above) return made_above;
  const bool is_made = ::mkdir(folder.c_str(), 0777) == 0;
  if (!is_made && errno != EEXIST) return fail(folder.string(), reason(errno));
  if (is_made && made) made->push_back(folder);
  if (!fs::is_directory(folder, problem)) return fail(folder.string(), reason(ENOTDIR));
  return flush_folder(above, folder);
}

StagedFiles::StagedFiles(StagedFiles&& other) noexcept
    : files_(std::exchange(other.files_, {})),
      in_place_(std::exchange(other.in_place_, 0)),
      made_folders_(std::exchange(other.made_folders_, {})) {}

StagedFiles& StagedFiles::operator=(StagedFiles&& other) noexcept {
  std::swap(files_, other.files_);
  std::swap(in_place_, other.in_place_);
  std::swap(made_folders_, other.made_folders_);
  return *this;
}

StagedFiles::~StagedFiles() {
  for (std::size_t i = in_place_; i < files_.size(); ++i) ::unlink(files_[i].temporary.c_str());
  // Fails where a file is in place, or something else has put one there.
  for (std::size_t i = made_folders_.size(); i-- > 0;) ::rmdir(made_folders_[i].c_str());
}

void StagedFiles::leave() {
  files_.resize(in_place_);
  made_folders_.clear();
}

Result<StagedFiles> StagedFiles::write(std::span<const PendingFile> files, const Progress& progress) {
  Written written(files, progress);
  StagedFiles staged;
  staged.files_.reserve(files.size());
  std::map<fs::path, fs::path> folders;
  for (const PendingFile& file : files) {
    Result<File> one = stage(file, written, staged.made_folders_);
    if (!one) return fail(std::move(one.error()));
    folders[folder_of(one->target)] = one->temporary;
    staged.files_.push_back(std::move(*one));
  }
  // Finds a folder that can't be flushed before anything is replaced.
  for (const auto& [folder, file] : folders)
    if (Result<void> flushed = flush_folder(folder, file); !flushed) return fail(std::move(flushed.error()));
  // Flushing may have taken long.
  if (!written.goes_on()) return fail(cancelled());
  return staged;
}

Result<void> StagedFiles::put_in_place(const Check& check) {
  for (; in_place_ < files_.size(); ++in_place_) {
    File& file = files_[in_place_];
    const Result<void> checked = check ? check(in_place_) : Result<void>();
    if (checked && ::rename(file.temporary.c_str(), file.target.c_str()) == 0) {
      const Result<FileIdentity> now = identify_file(file.target);
      if (now && is_same_but_for_name(*now, file.identity)) file.identity = *now;
      continue;
    }
    if (in_place_ == 0) return checked ? write_failure(file.shown, errno) : checked;
    return fail(file.shown.string(), (checked ? "can't be replaced: " + reason(errno) : checked.error().message) + "; " +
                                         std::to_string(in_place_) + " of " + std::to_string(files_.size()) +
                                         " files were already replaced, the last of them " + files_[in_place_ - 1].shown.string());
  }
  std::map<fs::path, fs::path> folders;
  for (const File& file : files_) folders[folder_of(file.target)] = file.target;
  for (const auto& [folder, file] : folders)
    if (Result<void> flushed = flush_folder(folder, file); !flushed) return flushed;
  made_folders_.clear();
  return {};
}

Result<void> replace_files(std::span<const PendingFile> files, const Progress& progress) {
  Result<StagedFiles> staged = StagedFiles::write(files, progress);
  if (!staged) return fail(std::move(staged.error()));
  return staged->put_in_place();
}

}  // namespace prismesh
