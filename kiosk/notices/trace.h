// Writes a line of text for each event, for programs that watch the kiosk (tests, the demo). docs/kiosk.md lists the lines.
#pragma once

#include <cstdio>
#include <string>

namespace prismesh::kiosk::notices {

class Trace {
 public:
  explicit Trace(std::FILE* file) : file_(file) {}  ///< null: writes nothing

  bool on() const { return file_ != nullptr; }
  void line(const std::string& text) const {
    if (file_ == nullptr) return;
    std::fprintf(file_, "%s\n", text.c_str());
    std::fflush(file_);
  }

 private:
  std::FILE* file_;
};

}  // namespace prismesh::kiosk::notices
