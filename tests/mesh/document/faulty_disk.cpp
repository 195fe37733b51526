#include "tests/mesh/document/faulty_disk.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace prismesh::mesh::document {

FaultyDisk disk;

void FaultyDisk::mend() {
  writes_left = -1;
  short_write = ends_early = other_device = false;
  write_error = read_error = sync_error = folder_sync_error = truncate_error = 0;
  lock_error = link_error = rename_error = rename_new_error = status_error = 0;
}

}  // namespace prismesh::mesh::document

using prismesh::mesh::document::disk;

namespace {

int refused_by_disk(int error) {
  errno = error;
  return -1;
}

}  // namespace

// These stand before the C library's of the same name.
extern "C" ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) {
  if (disk.writes_left >= 0 && disk.writes_left-- == 0) {
    if (disk.short_write.exchange(false)) {
      disk.writes_left = 0;
      return ::syscall(SYS_pwrite64, fd, data, size / 2, offset);
    }
    return refused_by_disk(disk.write_error);
  }
  return ::syscall(SYS_pwrite64, fd, data, size, offset);
}
extern "C" ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) { return pwrite(fd, data, size, offset); }
extern "C" ssize_t pread(int fd, void* data, size_t size, off_t offset) {
  if (disk.read_error != 0) return refused_by_disk(disk.read_error);
  return disk.ends_early ? 0 : ::syscall(SYS_pread64, fd, data, size, offset);
}
extern "C" ssize_t pread64(int fd, void* data, size_t size, off64_t offset) { return pread(fd, data, size, offset); }
extern "C" int ftruncate(int fd, off_t size) noexcept {
  if (disk.truncate_error != 0) return refused_by_disk(disk.truncate_error);
  return static_cast<int>(::syscall(SYS_ftruncate, fd, size));
}
extern "C" int ftruncate64(int fd, off64_t size) noexcept { return ftruncate(fd, size); }
// Really flushing would only cost time: no test here cuts the power.
extern "C" int fdatasync(int) { return disk.sync_error == 0 ? 0 : refused_by_disk(disk.sync_error); }
extern "C" int fsync(int) { return disk.folder_sync_error == 0 ? 0 : refused_by_disk(disk.folder_sync_error); }
extern "C" int flock(int fd, int how) noexcept {
  if (disk.lock_error != 0) return refused_by_disk(disk.lock_error);
  return static_cast<int>(::syscall(SYS_flock, fd, how));
}
extern "C" int link(const char* from, const char* to) noexcept {
  if (disk.link_error != 0) return refused_by_disk(disk.link_error);
  return static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}
extern "C" int rename(const char* from, const char* to) noexcept {
  if (disk.rename_error != 0) return refused_by_disk(disk.rename_error);
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
extern "C" int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned how) noexcept {
  if (disk.rename_new_error != 0) return refused_by_disk(disk.rename_new_error);
  return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, how));
}
extern "C" int fstat(int fd, struct stat* status) noexcept {
  if (disk.status_error != 0) return refused_by_disk(disk.status_error);
  const auto result = static_cast<int>(::syscall(SYS_fstat, fd, status));
  if (result == 0 && disk.other_device) ++status->st_dev;
  return result;
}
extern "C" int fstat64(int fd, struct stat64* status) noexcept { return fstat(fd, reinterpret_cast<struct stat*>(status)); }
