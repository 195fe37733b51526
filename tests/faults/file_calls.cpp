#include "tests/faults/file_calls.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <utility>

namespace prismesh::test {

void hang_where_told(const char* call) {
  const char* const where = std::getenv("PRISMESH_HANG_IN");
  const char* const mark = std::getenv("PRISMESH_HANG_MARK");
  if (where == nullptr || mark == nullptr || std::strcmp(where, call) != 0 || ::syscall(SYS_unlink, mark) != 0) return;
  for (;;) ::pause();
}

namespace {

using Kind = FileCall::Kind;

/// Nothing here may allocate before main: the calls below are used by whatever runs then.
struct Recorder {
  std::mutex mutex;
  std::atomic<bool> on{false};
  int log = -1;
  char folder[PATH_MAX] = {};
  std::size_t folder_size = 0;
  std::uint64_t calls = 0;
  Failure failure;
};
Recorder recorder;

bool is_below(const char* path) {
  if (std::strncmp(path, recorder.folder, recorder.folder_size) != 0) return false;
  return path[recorder.folder_size] == '/' || path[recorder.folder_size] == '\0';
}

/// The absolute path of `path` as a call at `at` names it; empty where nothing is recorded or it isn't below the folder.
std::string below(int at, const char* path) {
  if (!recorder.on || path == nullptr) return {};
  std::string whole;
  if (path[0] == '/') {
    whole = path;
  } else {
    char folder[PATH_MAX];
    if (at == AT_FDCWD) {
      if (::getcwd(folder, sizeof folder) == nullptr) return {};
    } else {
      char link[64];
      std::snprintf(link, sizeof link, "/proc/self/fd/%d", at);
      const ssize_t size = ::readlink(link, folder, sizeof folder - 1);
      if (size < 0) return {};
      folder[size] = '\0';
    }
    whole = std::string(folder) + "/" + path;
  }
  return is_below(whole.c_str()) ? whole : std::string();
}

struct OpenFile {
  std::string path;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;
  bool folder = false;
};

/// What a descriptor is open on; an empty path where that isn't below the folder.
OpenFile open_on(int fd) {
  OpenFile file;
  if (!recorder.on) return file;
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t size = ::readlink(link, path, sizeof path - 1);
  if (size <= 0) return file;
  path[size] = '\0';
  struct stat status {};
  if (!is_below(path) || ::fstat(fd, &status) != 0 || !(S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))) return file;
  file.path = path;
  file.inode = status.st_ino;
  file.size = static_cast<std::uint64_t>(status.st_size);
  file.folder = S_ISDIR(status.st_mode);
  return file;
}

void put(std::string& out, const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); }
void put(std::string& out, const std::string& text) {
  const std::uint64_t size = text.size();
  put(out, &size, sizeof size);
  out += text;
}

/// Written by one system call, so that a killed program leaves whole entries.
void note(const FileCall& call) {
  std::string out;
  put(out, &call.kind, sizeof call.kind);
  put(out, &call.inode, sizeof call.inode);
  put(out, &call.offset, sizeof call.offset);
  put(out, call.path);
  put(out, call.other);
  put(out, call.data);
  if (::syscall(SYS_write, recorder.log, out.data(), out.size()) != static_cast<long>(out.size())) std::abort();
}

/// Counts a call; its error if it is one that fails.
int counted() {
  ++recorder.calls;
  const Failure& failure = recorder.failure;
  if (failure.at == 0 || recorder.calls < failure.at) return 0;
  return recorder.calls == failure.at || failure.for_ever ? failure.error : 0;
}

/// Runs a call that concerns `path`: counted, failed or done, and noted if it was done.
template <class Call>
int recorded(bool concerns, const Call& call, const FileCall& what) {
  if (!concerns) return call();
  const std::lock_guard lock(recorder.mutex);
  if (const int error = counted(); error != 0) {
    errno = error;
    return -1;
  }
  const int result = call();
  if (result >= 0) {
    const int kept = errno;
    note(what);
    errno = kept;
  }
  return result;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::uint64_t inode_of(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

int opened(int at, const char* path, int flags, mode_t mode) {
  const auto call = [&] { return static_cast<int>(::syscall(SYS_openat, at, path, flags, mode)); };
  const std::string whole = (flags & (O_CREAT | O_TRUNC)) != 0 ? below(at, path) : std::string();
  if (whole.empty()) return call();
  const std::lock_guard lock(recorder.mutex);
  const bool was_there = inode_of(whole) != 0;
  if (was_there && (flags & O_TRUNC) == 0) return call();
  if (const int error = counted(); error != 0) {
    errno = error;
    return -1;
  }
  const int fd = call();
  if (fd < 0) return fd;
  if (!was_there) note({Kind::make, inode_of(whole), 0, whole, "", ""});
  if (was_there) note({Kind::truncate, inode_of(whole), 0, whole, "", ""});
  return fd;
}

ssize_t written(int fd, const iovec* pieces, int count, off_t offset) {
  const auto call = [&](const iovec* what, int how_many) {
    return offset < 0 ? ::syscall(SYS_writev, fd, what, how_many) : ::syscall(SYS_pwritev, fd, what, how_many, offset, 0);
  };
  const OpenFile file = open_on(fd);
  if (file.path.empty()) return call(pieces, count);
  const std::lock_guard lock(recorder.mutex);
  std::string data;
  for (int i = 0; i < count; ++i) data.append(static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len);
  if (const int error = counted(); error != 0) {
    if (!recorder.failure.cut_short || recorder.calls != recorder.failure.at || data.size() < 2) {
      errno = error;
      return -1;
    }
    data.resize(data.size() / 2);
  }
  const auto at = static_cast<std::uint64_t>(offset >= 0                              ? offset
                                             : (::fcntl(fd, F_GETFL) & O_APPEND) != 0 ? static_cast<off_t>(file.size)
                                                                                      : ::lseek(fd, 0, SEEK_CUR));
  const iovec whole{data.data(), data.size()};
  const ssize_t done = call(&whole, 1);
  if (done > 0) note({Kind::write, file.inode, at, file.path, "", data.substr(0, static_cast<std::size_t>(done))});
  return done;
}

int synced(int fd, long number) {
  hang_where_told("sync");
  const OpenFile file = open_on(fd);
  return recorded(!file.path.empty(),
                  [&] { return recorder.on ? 0 : static_cast<int>(::syscall(number, fd)); },  // no test cuts the power here
                  {file.folder ? Kind::sync_folder : Kind::sync, file.inode, 0, file.path, "", ""});
}

int renamed(int from_at, const char* from, int to_at, const char* to, unsigned flags) {
  const std::string source = below(from_at, from), target = below(to_at, to);
  return recorded(!source.empty() && !target.empty(),
                  [&] { return static_cast<int>(::syscall(SYS_renameat2, from_at, from, to_at, to, flags)); },
                  {Kind::rename, inode_of(source), 0, source, target, ""});
}

int removed(int at, const char* path, int flags) {
  const std::string whole = below(at, path);
  return recorded(!whole.empty() && inode_of(whole) != 0, [&] { return static_cast<int>(::syscall(SYS_unlinkat, at, path, flags)); },
                  {Kind::remove, 0, 0, whole, "", ""});
}

int linked(int from_at, const char* from, int to_at, const char* to, int flags) {
  const std::string source = below(from_at, from), target = below(to_at, to);
  return recorded(!source.empty() && !target.empty(),
                  [&] { return static_cast<int>(::syscall(SYS_linkat, from_at, from, to_at, to, flags)); },
                  {Kind::link, inode_of(source), 0, source, target, ""});
}

int folder_made(int at, const char* path, mode_t mode) {
  const std::string whole = below(at, path);
  return recorded(!whole.empty() && inode_of(whole) == 0, [&] { return static_cast<int>(::syscall(SYS_mkdirat, at, path, mode)); },
                  {Kind::make_folder, 0, 0, whole, "", ""});
}

}  // namespace

void record_file_calls(const std::filesystem::path& folder, const std::filesystem::path& log, const Failure& failure) {
  stop_recording_file_calls();
  recorder.log = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0600));
  if (recorder.log < 0 || folder.native().size() >= PATH_MAX) std::abort();
  std::strcpy(recorder.folder, folder.c_str());
  recorder.folder_size = folder.native().size();
  recorder.calls = 0;
  recorder.failure = failure;
  recorder.on = true;
}

void mark_file_calls(std::uint64_t number) {
  const std::lock_guard lock(recorder.mutex);
  note({Kind::mark, 0, number, "", "", ""});
}

std::uint64_t counted_file_calls() { return recorder.calls; }

void stop_recording_file_calls() {
  recorder.on = false;
  if (recorder.log >= 0) ::close(std::exchange(recorder.log, -1));
}

std::vector<FileCall> read_file_calls(const std::filesystem::path& log) {
  std::ifstream in(log, std::ios::binary);
  std::vector<FileCall> calls;
  const auto number = [&] {
    std::uint64_t value = 0;
    in.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  };
  const auto text = [&] {
    std::string value(number(), '\0');
    in.read(value.data(), static_cast<std::streamsize>(value.size()));
    return value;
  };
  FileCall call;
  while (in.read(reinterpret_cast<char*>(&call.kind), sizeof call.kind)) {
    call.inode = number();
    call.offset = number();
    call.path = text();
    call.other = text();
    call.data = text();
    if (!in) std::abort();
    calls.push_back(call);
  }
  return calls;
}

}  // namespace prismesh::test

// --- the calls ---

using namespace prismesh::test;

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = static_cast<mode_t>(va_arg(more, unsigned));
  va_end(more);
  return opened(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = static_cast<mode_t>(va_arg(more, unsigned));
  va_end(more);
  return opened(AT_FDCWD, path, flags, mode);
}
int openat(int at, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = static_cast<mode_t>(va_arg(more, unsigned));
  va_end(more);
  return opened(at, path, flags, mode);
}
int mkostemp(char* name, int flags) {
  const std::string whole = below(AT_FDCWD, name);
  const std::size_t size = std::strlen(name);
  for (int tries = 0; tries < 1000 && size >= 6; ++tries) {
    static std::atomic<unsigned> counter{0};
    char ending[16];
    std::snprintf(ending, sizeof ending, "%06u", (static_cast<unsigned>(::getpid()) * 7919U + counter++) % 1000000U);
    std::memcpy(name + size - 6, ending, 6);
    const int fd = opened(AT_FDCWD, name, flags | O_RDWR | O_CREAT | O_EXCL, 0600);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  errno = EEXIST;
  return -1;
}
int mkostemp64(char* name, int flags) { return mkostemp(name, flags); }

ssize_t write(int fd, const void* data, size_t size) {
  const iovec piece{const_cast<void*>(data), size};
  return written(fd, &piece, 1, -1);
}
ssize_t writev(int fd, const iovec* pieces, int count) { return written(fd, pieces, count, -1); }
ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) {
  const iovec piece{const_cast<void*>(data), size};
  return written(fd, &piece, 1, offset);
}
ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) { return pwrite(fd, data, size, offset); }

int ftruncate(int fd, off_t size) noexcept {
  const OpenFile file = open_on(fd);
  return recorded(!file.path.empty(), [&] { return static_cast<int>(::syscall(SYS_ftruncate, fd, size)); },
                  {FileCall::Kind::truncate, file.inode, static_cast<std::uint64_t>(size), file.path, "", ""});
}
int ftruncate64(int fd, off64_t size) noexcept { return ftruncate(fd, size); }

int fsync(int fd) { return synced(fd, SYS_fsync); }
int fdatasync(int fd) { return synced(fd, SYS_fdatasync); }
int syncfs(int fd) noexcept {
  const OpenFile file = open_on(fd);
  return recorded(!file.path.empty(), [] { return 0; }, {FileCall::Kind::sync_all, 0, 0, file.path, "", ""});
}

int rename(const char* from, const char* to) noexcept { return renamed(AT_FDCWD, from, AT_FDCWD, to, 0); }
int renameat(int from_at, const char* from, int to_at, const char* to) noexcept { return renamed(from_at, from, to_at, to, 0); }
int renameat2(int from_at, const char* from, int to_at, const char* to, unsigned flags) noexcept {
  return renamed(from_at, from, to_at, to, flags);
}
int link(const char* from, const char* to) noexcept { return linked(AT_FDCWD, from, AT_FDCWD, to, 0); }
int linkat(int from_at, const char* from, int to_at, const char* to, int flags) noexcept { return linked(from_at, from, to_at, to, flags); }
int unlink(const char* path) noexcept { return removed(AT_FDCWD, path, 0); }
int unlinkat(int at, const char* path, int flags) noexcept { return removed(at, path, flags); }
int remove(const char* path) noexcept {
  const int result = removed(AT_FDCWD, path, 0);
  return result < 0 && errno == EISDIR ? removed(AT_FDCWD, path, AT_REMOVEDIR) : result;
}
int rmdir(const char* path) noexcept { return removed(AT_FDCWD, path, AT_REMOVEDIR); }
int mkdir(const char* path, mode_t mode) noexcept { return folder_made(AT_FDCWD, path, mode); }
int mkdirat(int at, const char* path, mode_t mode) noexcept { return folder_made(at, path, mode); }

}  // extern "C"
