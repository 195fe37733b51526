#include "drivers/port/open_error.h"

#include <grp.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace prismesh::drivers::port {

namespace {

namespace fs = std::filesystem;

/// Lists the serial devices in the folder of stable names, as the end of a sentence.
std::string plugged_in_devices() {
  std::error_code ignored;
  std::vector<std::string> names;
  for (fs::directory_iterator entry("/dev/serial/by-id", ignored), end; !ignored && entry != end; entry.increment(ignored))
    names.push_back(entry->path().string());
  if (names.empty()) return "no serial device is plugged in (/dev/serial/by-id is empty)";
  std::sort(names.begin(), names.end());
  std::string text = "plugged in now:";
  for (const std::string& name : names) text += " " + name;
  return text;
}

std::string group_of(const std::string& path) {
  struct stat what {};
  if (::stat(path.c_str(), &what) != 0) return "dialout";
  const group* found = ::getgrgid(what.st_gid);  // NOLINT(concurrency-mt-unsafe): opening is done by one thread
  return found != nullptr ? found->gr_name : std::to_string(what.st_gid);
}

std::string program_name(const fs::path& process) {
  std::string name;
  std::ifstream(process / "comm") >> name;
  return name;
}

/// Returns "prog (process 12)" for each process that has the file open. Processes of other users can't be inspected.
std::string holders(const std::string& path) {
  struct stat wanted {};
  if (::stat(path.c_str(), &wanted) != 0) return {};
  std::string text;
  std::error_code ignored;
  for (fs::directory_iterator process("/proc", ignored), end; !ignored && process != end; process.increment(ignored)) {
    const std::string id = process->path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos) continue;
    std::error_code unreadable;
    for (fs::directory_iterator open(process->path() / "fd", unreadable), last; !unreadable && open != last; open.increment(unreadable)) {
      struct stat what {};
      if (::stat(open->path().c_str(), &what) != 0 || !S_ISCHR(what.st_mode) || what.st_rdev != wanted.st_rdev) continue;
      text += (text.empty() ? "" : ", ") + program_name(process->path()) + " (process " + id + ")";
      break;
    }
  }
  return text;
}

std::string advice(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO: return "there is no such device; is it plugged in and switched on? " + plugged_in_devices();
    case EPERM:  // not of the file's rights: systemd keeps devices from a unit by the kernel driver's number, which it looks up at the
                 // start
      return "systemd keeps this device from the program's unit: start the unit again now that the device's driver is there (sudo "
             "systemctl "
             "restart prismesh-deviced), or allow it there (DeviceAllow=)";
    case EACCES: {
      const std::string group = group_of(path);
      return "this user may not open it: install systemd/udev/60-prismesh.rules and plug the device in again, or join its group "
             "(sudo usermod -aG " +
             group + " $USER) and log in again";
    }
    case EBUSY:
    case EWOULDBLOCK: {
      const std::string who = holders(path);
      return "another program has it open: " +
             (who.empty() ? "one that can't be seen from here; sudo fuser -v " + path + " names it" : who) +
             "; end that program, or give this one another port";
    }
    case ENOTTY:
    case EINVAL: return "is no serial line; give the device's own file, such as one in /dev/serial/by-id";
    case EIO: return "doesn't answer; pull the plug and put it in again";
    default: return std::string("can't be opened: ") + std::strerror(error);
  }
}

}  // namespace

Error open_error(const std::string& path, int error) { return {path, 0, advice(path, error)}; }

Error usb_open_error(const std::string& name, const std::string& path, int error) {
  const auto says = [&](const std::string& sentence) { return Error{name + " (" + path + ")", 0, sentence}; };
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO: return says("was unplugged while it was opened");
    case EACCES:
      return says("this user may not open it: install systemd/udev/60-prismesh.rules, whose line for the " + name +
                  " opens it to the group prismesh and to the user at the station, and plug the device in again");
    case EPERM: {
      const bool hidraw = path.find("hidraw") != std::string::npos;
      return says("systemd keeps it from the program's unit: allow it there (DeviceAllow=" +
                  std::string(hidraw ? "char-hidraw r)" : "char-usb_device rw)"));
    }
    case EBUSY: {
      const std::string who = holders(path);
      return says("another program uses it" + (who.empty() ? std::string() : ": " + who) + "; end that program");
    }
    case EIO:
    case ETIMEDOUT: return says("doesn't answer; pull its plugs and put them in again");
    default: return says(std::string("can't be opened: ") + std::strerror(error));
  }
}

int lock(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return 0;
  return errno == EWOULDBLOCK ? EBUSY : errno;
}

int refuse_others(int descriptor) { return ::ioctl(descriptor, TIOCEXCL) == 0 ? 0 : errno; }

}  // namespace prismesh::drivers::port
