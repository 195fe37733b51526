#include "drivers/port/file_watch.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

namespace prismesh::drivers::port {

namespace {

namespace fs = std::filesystem;

/// Returns the nearest existing folder above `path`, and the name of the next path component in it.
std::pair<fs::path, fs::path> nearest_folder(const fs::path& path) {
  std::error_code ignored;
  fs::path folder = path.parent_path(), next = path.filename();
  while (folder.has_relative_path() && !fs::is_directory(folder, ignored)) {
    next = folder.filename();
    folder = folder.parent_path();
  }
  return {folder.empty() ? "." : folder, next};
}

}  // namespace

FileWatch::FileWatch(std::vector<std::string> paths) : descriptor_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  for (std::string& path : paths) {
    watched_.push_back({std::move(path), {}, {}, -1, false});
    watch_nearest(watched_.back());
  }
}

FileWatch::~FileWatch() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FileWatch::watch_nearest(Watched& watched) {
  if (descriptor_ < 0 || watched.path.empty()) return;
  const int before = watched.watch;
  // A folder may appear between the search and the start of the watch, so repeat until the result is stable.
  for (int attempt = 0; attempt < 16; ++attempt) {
    const auto [folder, name] = nearest_folder(watched.path);
    if (attempt > 0 && folder == watched.folder && watched.watch >= 0) break;
    watched.folder = folder.string();
    watched.name = name.string();
    watched.watch = ::inotify_add_watch(descriptor_, watched.folder.c_str(),
                                        IN_CREATE | IN_MOVED_TO | IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR);
  }
  const auto uses = [&](int watch) {
    return std::any_of(watched_.begin(), watched_.end(), [&](const Watched& other) { return other.watch == watch; });
  };
  if (before >= 0 && before != watched.watch && !uses(before)) ::inotify_rm_watch(descriptor_, before);
}

void FileWatch::mark_touched(int watch, std::string_view name) {
  for (Watched& watched : watched_)
    if (watched.watch == watch && (name.empty() || name == watched.name)) watched.touched = true;
}

std::vector<std::size_t> FileWatch::changed_paths() {
  alignas(inotify_event) std::array<char, 4096> buffer{};
  ssize_t length = 0;
  while (descriptor_ >= 0 && (length = ::read(descriptor_, buffer.data(), buffer.size())) > 0) {
    for (const char* at = buffer.data(); at < buffer.data() + length;) {
      inotify_event event{};
      std::memcpy(&event, at, sizeof event);
      const std::string_view name(event.len > 0 ? at + sizeof event : "");  // the kernel pads with NUL
      at += sizeof event + event.len;
      const bool lost_some = (event.mask & IN_Q_OVERFLOW) != 0;
      for (Watched& watched : watched_) watched.touched |= lost_some;
      mark_touched(event.wd, (event.mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) != 0 ? std::string_view() : name);
    }
  }
  std::vector<std::size_t> found;
  std::error_code ignored;
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    if (!std::exchange(watched_[i].touched, false)) continue;
    watch_nearest(watched_[i]);
    if (fs::exists(watched_[i].path, ignored)) found.push_back(i);
  }
  return found;
}

}  // namespace prismesh::drivers::port
