// Checks on paths that clients name.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace prismesh::modeld {

inline bool is_there(const std::filesystem::path& path) {
  std::error_code problem;
  return std::filesystem::exists(path, problem);
}

inline bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code problem;
  return std::filesystem::equivalent(a, b, problem) && !problem;
}

/// Returns the path unchanged. Errors: it isn't absolute.
inline Result<std::filesystem::path> absolute(const std::string& path) {
  if (!std::filesystem::path(path).is_absolute()) return fail(path, "the path must be absolute: the daemon has its own working folder");
  return std::filesystem::path(path);
}

}  // namespace prismesh::modeld
