// Reports when a device's file may have appeared or changed its permissions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::drivers::port {

/// Watches paths that may not exist, and whose folders may not exist (/dev/serial/by-id disappears with the last device): watches the
/// nearest existing folder above. If inotify isn't available (its instances are used up), `descriptor` is -1 and nothing is reported, so
/// callers must also use a timeout.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::string> paths);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Becomes readable (poll) when `changed_paths` may have something to report.
  int descriptor() const { return descriptor_; }
  /// Reads the pending inotify events and renews the watches. Returns the indices of the paths that changed and exist.
  std::vector<std::size_t> changed_paths();

 private:
  struct Watched {
    std::string path;
    std::string folder;  // the nearest existing folder
    std::string name;    // the path's next component in that folder
    int watch = -1;
    bool touched = false;
  };
  void watch_nearest(Watched& watched);
  void mark_touched(int watch, std::string_view name);

  int descriptor_ = -1;
  std::vector<Watched> watched_;
};

}  // namespace prismesh::drivers::port
