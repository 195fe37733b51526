// Tells the documents apart that are opened one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace prismesh::kiosk::link {

class DocumentNumber {
 public:
  /// Counts up each time that another document is opened; 0: none has been.
  std::uint64_t value() const { return value_; }
  /// Of the document; empty: none is open.
  const std::string& path() const { return path_; }

  /// The document of this path is open.
  void follow(const std::string& path) {
    // Under another name of its own it isn't another document.
    if (std::exchange(path_, path) != path && path != becoming_) ++value_;
  }
  /// It is being saved under a name with which it will go on; empty: it isn't any more.
  void becomes(const std::string& path) { becoming_ = path; }
  /// It has been.
  void rename(const std::string& path) { path_ = path; }
  void close() { path_.clear(); }

 private:
  std::uint64_t value_ = 0;
  std::string path_;
  std::string becoming_;
};

}  // namespace prismesh::kiosk::link
