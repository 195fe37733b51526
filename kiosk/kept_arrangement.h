// Keeps how the user has arranged the panels, over restarts.
#pragma once

#include <filesystem>

#include "kiosk/panels/places.h"

namespace prismesh::kiosk {

class KeptArrangement {
 public:
  /// Reads the file; one that is missing or can't be read is the usual arrangement. An empty path: nothing is kept.
  explicit KeptArrangement(std::filesystem::path file);

  const panels::Arrangement& now() const { return now_; }
  void set(const panels::Arrangement& wanted) { now_ = panels::within_limits(wanted); }
  /// Writes the file if the arrangement has changed since. A failure to write is ignored: the next change tries again.
  void keep();

 private:
  std::filesystem::path file_;
  panels::Arrangement now_, kept_;
};

}  // namespace prismesh::kiosk
