#include "kiosk/toolkit/history_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "base/file.h"

namespace prismesh::kiosk::toolkit {

namespace fs = std::filesystem;

fs::path kiosk_state_folder() {
  const auto folder = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read at the program's start
    return value != nullptr ? value : "";
  };
  if (const fs::path state = folder("XDG_STATE_HOME"); state.is_absolute()) return state / "prismesh";
  if (const fs::path home = folder("HOME"); home.is_absolute()) return home / ".local" / "state" / "prismesh";
  return {};
}

HistoryFile::HistoryFile(fs::path file) : file_(std::move(file)) {
  if (file_.empty()) return;
  const Result<FileBytes> bytes = read_file(file_);
  if (!bytes) return;
  std::string_view text = bytes->text();
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (!line.empty() && line.size() <= kMaxBytes) entries_.emplace_back(line);
  }
  if (entries_.size() > kMax) entries_.erase(entries_.begin(), entries_.end() - kMax);
}

void HistoryFile::add(const std::string& entry) {
  if (entry.empty() || entry.size() > kMaxBytes || entry.find('\n') != std::string::npos) return;
  std::erase(entries_, entry);
  entries_.push_back(entry);
  if (entries_.size() > kMax) entries_.erase(entries_.begin());
  if (file_.empty()) return;
  std::string text;
  for (const std::string& each : entries_) text += each + "\n";
  const std::array<PendingFile, 1> pending{PendingFile{file_, {text}}};
  (void)replace_files(pending);
}

}  // namespace prismesh::kiosk::toolkit
