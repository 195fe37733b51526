// Keeps lines that were entered in a file, oldest first.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prismesh::kiosk::toolkit {

/// The kiosk's folder for state that outlives it: $XDG_STATE_HOME/prismesh, else ~/.local/state/prismesh; empty where neither is known.
std::filesystem::path kiosk_state_folder();

class HistoryFile {
 public:
  static constexpr std::size_t kMax = 200;        ///< entries; the oldest go
  static constexpr std::size_t kMaxBytes = 4096;  ///< of an entry; a longer one isn't kept

  HistoryFile() = default;
  /// Reads the file; one that is missing or can't be read is an empty history. An empty path: nothing is kept over restarts.
  explicit HistoryFile(std::filesystem::path file);

  const std::vector<std::string>& entries() const { return entries_; }
  /// Adds an entry at the end, or moves it there. Writes the whole file at once; a failure to write is ignored.
  void add(const std::string& entry);

 private:
  std::filesystem::path file_;
  std::vector<std::string> entries_;
};

}  // namespace prismesh::kiosk::toolkit
