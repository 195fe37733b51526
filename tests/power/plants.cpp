// Faults of durability, planted into a whole program from outside (LD_PRELOAD): PRISMESH_PLANT names one. They stand between the program
// and the C library, so that the product holds no switch for them. tests/power/planted.py says what each is, and what must notice it.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

namespace {

using namespace std::chrono_literals;

constexpr auto kLater = 80ms;  ///< some ten steps of a session
constexpr auto kGap = 30ms;

bool planted(std::string_view name) {
  static const std::string plant = [] {
    const char* const named = std::getenv("PRISMESH_PLANT");
    return std::string(named == nullptr ? "" : named);
  }();
  return plant == name;
}

std::string path_of(int fd) {
  char path[4096];
  const ssize_t size = ::readlink(("/proc/self/fd/" + std::to_string(fd)).c_str(), path, sizeof path);
  return size < 0 ? std::string() : std::string(path, static_cast<std::size_t>(size));
}

bool is_folder(int fd) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && S_ISDIR(status.st_mode);
}

bool holds(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }
bool is_journal(std::string_view path) { return holds(path, ".journal") && !holds(path, ".saving") && !holds(path, "catalogue"); }
/// What a save writes beside the deck's files, before it is renamed.
bool is_new_deck(std::string_view path) { return holds(path, "/deck/."); }

void later(std::function<void()> work) {
  std::thread([work = std::move(work)] {
    std::this_thread::sleep_for(kLater);
    work();
  }).detach();
}

int really_flush(int fd, long number) { return static_cast<int>(::syscall(number, fd)); }

/// A journal is made by fsync, and takes each edit by fdatasync.
int flush(int fd, long number) {
  const std::string path = path_of(fd);
  const bool folder = is_folder(fd);
  const bool forgotten = (planted("journal-unflushed") && is_journal(path) && number == SYS_fdatasync) ||
                         (planted("new-journal-unflushed") && is_journal(path) && number == SYS_fsync) ||
                         (planted("folder-unflushed") && folder) || (planted("deck-unflushed") && is_new_deck(path)) ||
                         (planted("content-unflushed") && holds(path, "/incoming/")) ||
                         (planted("record-unflushed") && holds(path, "/models/"));
  if (forgotten) return 0;
  if (planted("journal-flushed-later") && is_journal(path) && number == SYS_fdatasync) {
    const int again = ::fcntl(fd, F_DUPFD_CLOEXEC, 0);
    later([again, number] {
      really_flush(again, number);
      ::close(again);
    });
    return 0;
  }
  return really_flush(fd, number);
}

int really_rename(int from_at, const char* from, int to_at, const char* to, unsigned flags) {
  return static_cast<int>(::syscall(SYS_renameat2, from_at, from, to_at, to, flags));
}

int rename_file(int from_at, const char* from, int to_at, const char* to, unsigned flags) {
  const std::string whole = to_at == AT_FDCWD ? std::string(to) : path_of(to_at) + "/" + to;
  if (planted("record-renamed-later") && holds(whole, "/models/")) {
    later([from_at = ::fcntl(from_at, F_DUPFD_CLOEXEC, 0), from = std::string(from), to_at = ::fcntl(to_at, F_DUPFD_CLOEXEC, 0),
           to = std::string(to), flags] { really_rename(from_at, from.c_str(), to_at, to.c_str(), flags); });
    return 0;
  }
  if (planted("deck-removed-first") && holds(whole, "/deck/")) {
    ::syscall(SYS_unlinkat, to_at, to, 0);
    std::this_thread::sleep_for(kGap);
  }
  const int result = really_rename(from_at, from, to_at, to, flags);
  if (planted("save-unrecorded")) {
    // Both records of a save, in the state folder and beside the deck, are gone before the first file is replaced; the files follow slowly.
    if (result == 0 && whole.ends_with(".saving")) ::syscall(SYS_unlinkat, to_at, to, 0);
    if (holds(whole, "/deck/")) std::this_thread::sleep_for(kGap);
  }
  return result;
}

ssize_t write_at(int fd, const void* data, size_t size, off_t offset) {
  const bool halved = (planted("journal-half-written") && offset > 0 && is_journal(path_of(fd))) ||
                      (planted("content-half-written") && holds(path_of(fd), "/incoming/"));
  if (!halved || size < 2) return ::syscall(SYS_pwrite64, fd, data, size, offset);
  // A short write that is taken for a whole one.
  const ssize_t half = ::syscall(SYS_pwrite64, fd, data, size / 2, offset);
  if (half < 0 || ::syscall(SYS_ftruncate, fd, offset + static_cast<off_t>(size)) != 0) return -1;
  return static_cast<ssize_t>(size);
}

}  // namespace

extern "C" {

int fsync(int fd) { return flush(fd, SYS_fsync); }
int fdatasync(int fd) { return flush(fd, SYS_fdatasync); }

int rename(const char* from, const char* to) noexcept { return rename_file(AT_FDCWD, from, AT_FDCWD, to, 0); }
int renameat2(int from_at, const char* from, int to_at, const char* to, unsigned flags) noexcept {
  return rename_file(from_at, from, to_at, to, flags);
}

int link(const char* from, const char* to) noexcept {
  const int result = static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
  if (planted("save-unrecorded") && result == 0 && std::string_view(to).ends_with(".saving")) ::syscall(SYS_unlinkat, AT_FDCWD, to, 0);
  return result;
}

ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) { return write_at(fd, data, size, offset); }
ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) { return write_at(fd, data, size, offset); }

/// The check of each record of a journal: where it is ignored, all have the same.
std::uint64_t XXH3_64bits(const void* data, size_t size) {
  using Hash = std::uint64_t (*)(const void*, size_t);
  static const Hash real = reinterpret_cast<Hash>(::dlsym(RTLD_NEXT, "XXH3_64bits"));
  return planted("check-ignored") ? 0 : real(data, size);
}

}  // extern "C"
