// Tells when a device's file may have appeared or changed its permissions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::drivers::port {

/// Watches paths that may not exist, nor their folders (/dev/serial/by-id goes away with the last device): always the nearest folder that
/// does. Without inotify (its instances are used up) `descriptor` is -1, nothing is ever told, and callers live by their timeouts.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::string> paths);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Readable (poll) when there may be news.
  int descriptor() const { return descriptor_; }
  /// Reads the news and watches anew. Indices of the paths that were touched and exist.
  std::vector<std::size_t> news();

 private:
  struct Watched {
    std::string path;
    std::string folder;  // the nearest that exists
    std::string name;    // the path's next component inside it
    int watch = -1;
    bool touched = false;
  };
  void watch_nearest(Watched& watched);
  void mark_touched(int watch, std::string_view name);

  int descriptor_ = -1;
  std::vector<Watched> watched_;
};

}  // namespace prismesh::drivers::port
