#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ipc/server.h"

namespace prismesh::ipc {

Result<void> make_private_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  if (folder.has_parent_path()) std::filesystem::create_directories(folder.parent_path(), problem);
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return fail(folder.string(), std::string("can't be made: ") + std::strerror(errno));
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0) return fail(folder.string(), std::strerror(errno));
  if (!S_ISDIR(status.st_mode)) return fail(folder.string(), "is no folder");
  if (status.st_uid != ::geteuid()) return fail(folder.string(), "belongs to another user; name a folder of your own");
  if ((status.st_mode & 0022) != 0) return fail(folder.string(), "others may write to it; make it private (chmod 700) or name another");
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
  const std::string own = std::to_string(::getpid()) + "\n";
  if (::ftruncate(lock.get(), 0) != 0 || ::pwrite(lock.get(), own.data(), own.size(), 0) != static_cast<ssize_t>(own.size()))
    return fail(path.string(), std::string("can't be written: ") + std::strerror(errno));
  return lock;
}

}  // namespace prismesh::ipc
