#include "ipc/wire/runtime_directory.h"

#include <cstdlib>
#include <string>

#include <unistd.h>

namespace prismesh::ipc {

std::filesystem::path runtime_directory(const std::optional<std::filesystem::path>& override) {
  if (override) return *override;
  if (const char* folder = std::getenv("RUNTIME_DIRECTORY"); folder != nullptr && *folder != 0) {
    // systemd separates several by colons; the first is ours.
    const std::string all = folder;
    return all.substr(0, all.find(':'));
  }
  if (const char* folder = std::getenv("XDG_RUNTIME_DIR"); folder != nullptr && *folder != 0)
    return std::filesystem::path(folder) / "prismesh";
  return "/tmp/prismesh-" + std::to_string(::geteuid());
}

std::filesystem::path state_directory(const std::optional<std::filesystem::path>& override) {
  if (override) return *override;
  if (const char* folder = std::getenv("STATE_DIRECTORY"); folder != nullptr && *folder != 0) {
    const std::string all = folder;
    return all.substr(0, all.find(':'));
  }
  if (const char* folder = std::getenv("XDG_STATE_HOME"); folder != nullptr && *folder != 0)
    return std::filesystem::path(folder) / "prismesh";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr && *home != 0 ? home : "/") / ".local/state/prismesh";
}

}  // namespace prismesh::ipc
