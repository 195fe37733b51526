#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "ipc/wire/server.h"

namespace prismesh::ipc {

Result<void> make_private_folder(const std::filesystem::path& path, bool others_enter) {
  const mode_t mode = others_enter ? 0711 : 0700;
  // A slash at the end would follow a link.
  const std::filesystem::path folder = path.has_filename() ? path : path.parent_path();
  if (const Result<void> made = make_folders(folder_of(folder)); !made)
    return fail(folder.string(), "can't be made: " + made.error().text());
  if (::mkdir(folder.c_str(), mode) == 0) {
    if (Result<void> flushed = flush_folder(folder_of(folder), folder); !flushed) return flushed;
  } else if (errno != EEXIST) {
    return fail(folder.string(), std::string("can't be made: ") + std::strerror(errno));
  }
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0) return fail(folder.string(), std::strerror(errno));
  if (!S_ISDIR(status.st_mode)) return fail(folder.string(), "is no folder");
  if (status.st_uid != ::geteuid()) return fail(folder.string(), "belongs to another user; name a folder of your own");
  if ((status.st_mode & 0022) != 0) return fail(folder.string(), "others may write to it; make it private (chmod 700) or name another");
  if ((status.st_mode & 0777) != mode && ::chmod(folder.c_str(), mode) != 0)
    return fail(folder.string(), std::string("its rights can't be set: ") + std::strerror(errno));
  return {};
}

Result<Descriptor> lock_folder(const std::filesystem::path& folder, const std::string& file, const std::string& whose) {
  const std::filesystem::path path = folder / file;
  Descriptor lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!lock) return fail(path.string(), std::string("can't be opened: ") + std::strerror(errno));
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return fail(path.string(), std::string("can't be locked: ") + std::strerror(errno));
    char holder[32] = {};
    const ssize_t count = ::pread(lock.get(), holder, sizeof holder - 1, 0);
    std::string who = count > 0 ? std::string(holder, static_cast<std::size_t>(count)) : "?";
    while (!who.empty() && who.back() == '\n') who.pop_back();
    return fail(folder.string(), whose + " already runs here (process " + who + "); stop it, or give this one another folder");
  }
  // The process's id is only for people who look for the lock's holder; on a full disk it is missing.
  const std::string own = std::to_string(::getpid()) + "\n";
  if (::ftruncate(lock.get(), 0) == 0) (void)!::pwrite(lock.get(), own.data(), own.size(), 0);
  return lock;
}

}  // namespace prismesh::ipc
